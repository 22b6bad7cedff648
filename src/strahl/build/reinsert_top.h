// build/reinsert_top.h - the upper nodes of a binary tree moved to where they cost less.
//
// Source: [MeisterBittner2018b], build/optimise.h; as in [Bittner2013], effort goes where it
//   counts.
// Method: subtrees of few nodes are moved as a whole, so a round takes a fraction of the time of
//   one over all leaves, and leaves may have several references.
// Invariants: leaves and what is below the nodes moved stay; the same tree for any number of
//   threads.
// Thread safety: pure functions.
#pragma once

#include <cstdint>

#include <strahl/build/optimise.h>
#include <strahl/build/tree.h>

namespace strahl {

struct TopRules {
  ReinsertionRules reinsertion{.rounds = 1};
  std::uint32_t whole = 15;    ///< subtrees of so many nodes at most are not taken apart
  double least_overlap = 0.1;  ///< of the children of upper nodes, as a part of their area: where
                               ///< it is less the tree is good, as over height fields
  int max_depth = 64;          ///< a tree that would become deeper stays as it is
};

/// O(n) and what the rounds take. Throws Error{cancelled}, Error{resource}.
Tree reinsert_top(Tree tree, const TopRules& rules, const BuildContext& context);

}  // namespace strahl
