// build/linked_tree.h - a binary tree whose nodes know their parents, in any order: what bottom-up
// builders write and optimisers edit.
//
// Invariants: one reference per leaf; the children of an inner node name it as their parent; a
//   node's box is the union of its children's.
// Thread safety: values.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/build/prim_ref.h>
#include <strahl/build/tree.h>

namespace strahl {

struct LinkedNode {
  static constexpr std::uint32_t kNone = ~0u;

  Aabb box;
  std::uint32_t parent = kNone;
  std::uint32_t left = kNone;   ///< kNone in leaves
  std::uint32_t right = kNone;  ///< leaves: the reference

  bool is_leaf() const { return left == kNone; }
  std::uint32_t sibling_of(std::uint32_t child) const { return left == child ? right : left; }
};

struct LinkedTree {
  std::vector<LinkedNode> nodes;
  std::uint32_t root = 0;

  /// One leaf per reference, in order, and room for the inner nodes; no tree yet.
  static LinkedTree of_leaves(std::span<const PrimRef> refs);
  /// A new inner node over two nodes without a parent.
  std::uint32_t join(std::uint32_t left, std::uint32_t right);
  /// Puts `fresh` where `old` is below old's parent.
  void replace_child(std::uint32_t old, std::uint32_t fresh);
  /// Makes the boxes from `node` up the unions of their children's, until one does not change.
  void refit_from(std::uint32_t node);
  /// Sum of the half areas of the inner nodes: what optimisers lower.
  double inner_area() const;
};

/// The same tree, editable. Requires: single references in the leaves.
LinkedTree make_linked(const Tree& tree);

/// The same tree, depth first; the left child of a node is the one whose centre is lower on the
/// axis on which they differ most. O(n), without recursion.
Tree make_tree(const LinkedTree& linked);

/// The same tree, or one in which no leaf is deeper than max_depth: subtrees that are too high are
/// divided anew by SAH sweep, as low as leaves that division eight levels more than a balanced tree
/// needs. Requires: 2^max_depth leaves at most. O(n), without recursion over the given tree.
Tree limit_depth(Tree tree, int max_depth, const SahCost& cost, const BuildContext& context);

}  // namespace strahl
