// build/optimise.h - binary trees made cheaper after they are built: rotations and reinsertion.
//
// Both lower the sum of the areas of the inner nodes, which is what the SAH cost of trees with one
//   primitive per leaf depends on; leaves of several are made afterwards (build/collapse.h).
// Rotations [Kensler2008]: from the leaves up, a node exchanges a child with a child of the other
//   one, or children of both, whichever of the six ways lowers the sum most; in passes.
// Reinsertion [MeisterBittner2018b]: in rounds, every node searches the whole tree for the place
// where it would lower the sum most, by branch and bound from its parent
//   upwards; then nodes are moved in the order of what they promise.
// Differs from the paper: instead of locks on what a move touches, moves are made one after the
//   other, what each changes is added up on the way, and it is taken back where it does not help.
// Invariants: no step raises the sum; the set of leaves stays; the tree is the same for any number
//   of threads. Depth is not bounded.
#pragma once

#include <strahl/base/build_context.h>
#include <strahl/build/linked_tree.h>

namespace strahl {

/// O(n) per pass. Throws Error{cancelled}.
void rotate_tree(LinkedTree& tree, const BuildContext& context);

struct ReinsertionRules {
  int rounds = 12;           ///< at most
  double least_gain = 1e-3;  ///< of a round, relative; below it is the last one
};

/// O(n * depth) and more per round. Throws Error{cancelled}.
void reinsert_nodes(LinkedTree& tree, const ReinsertionRules& rules, const BuildContext& context);

/// Bytes of a round beside the tree.
constexpr std::uint64_t reinsertion_bytes(std::uint64_t primitives) { return 48 * primitives; }

}  // namespace strahl
