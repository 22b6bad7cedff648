// build/insertion_tree.h - a tree of any arity, grown by inserting one primitive after the other
// where the expected cost grows least.
//
// Source: [GoldsmithSalmon1987]; costs, inherited costs and the
//   search with bounds after Arvo, all in [HainesNews].
// Cost:   a tree costs the sum over its inner nodes of children * area. A primitive may become the
//   sibling of a node, both under a new one (two times the new area), or a further child of an
//   inner node (its new area, and the growth for the children it has); what its ancestors grow by
//   is inherited.
// Differs from the paper: nodes take max_children at most, so that layouts with room for so many
//   can hold them; a tree that becomes deeper than allowed is mended where that happens, as
//   scapegoat trees are: the lowest subtree with levels to spare is divided anew by SAH sweep.
// Invariants: the tree depends on the boxes, the rules and the order only; areas of a node are
//   those of the exact box of what is below it.
#pragma once

#include <cstdint>
#include <span>

#include <strahl/base/build_context.h>
#include <strahl/build/hierarchy.h>
#include <strahl/build/prim_ref.h>
#include <strahl/build/sah.h>

namespace strahl {

/// Where a primitive is looked for a place: down one path, to the child whose area grows least or
/// that offers the lower cost itself; or everywhere that may be cheaper than what is found.
enum class InsertSearch { growth, local, branch_and_bound };
/// As they come, by their centres on the longest axis, or at random.
enum class InsertOrder { file, sorted, shuffled };

struct InsertionRules {
  InsertSearch search = InsertSearch::local;
  InsertOrder order = InsertOrder::file;
  std::uint64_t seed = 0;  ///< of the shuffle
  /// A descent ends, and the primitive becomes a child of the node, where each of the node's
  /// children would reach this part of the node's area with it.
  double attach_share = 0.9;
  std::uint32_t max_children = 16;  ///< of a node, 2 or more; with 2 the tree is binary
  SahCost cost;                     ///< decides what becomes a leaf at the end
  std::size_t max_leaf = 4;
  int max_depth = 64;  ///< at least the levels of a balanced tree and 8
};

/// Branch and bound looks at so many nodes per primitive and takes the best place by then: where
/// all boxes coincide, no bound helps.
constexpr int kMaxInsertVisits = 512;

/// n > 0. O(n log n) where boxes are small; branch and bound looks at several paths.
/// Throws Error{cancelled}, Error{resource}.
Hierarchy build_insertion_tree(std::span<const PrimRef> refs, const InsertionRules& rules,
                               const BuildContext& context);

/// What the insertions keep low: boxes and single primitives that a random line through the root's
/// box is expected to be tested against.
double insertion_cost(const Hierarchy& hierarchy);

}  // namespace strahl
