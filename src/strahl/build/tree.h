// build/tree.h - the neutral binary tree that object-dividing builders make and layouts consume.
//
// Layout: depth first; the left child follows its parent, `right` is the index of the right one.
// Invariants: an inner node's box encloses its children's; the references of a leaf ascend; leaves
//   own consecutive runs of `references` in the order of the nodes.
// Thread safety: values.
#pragma once

#include <cstdint>
#include <vector>

#include <strahl/build/sah.h>
#include <strahl/math/aabb.h>

namespace strahl {

/// A leaf when count > 0.
struct TreeNode {
  Aabb box;
  std::uint32_t right = 0;  ///< inner nodes: index of the right child
  std::uint32_t first = 0;  ///< leaves: position of the first reference
  std::uint32_t count = 0;  ///< leaves: number of references
  std::uint32_t axis = 0;   ///< inner nodes: the left child's centres lie lower on it

  bool is_leaf() const { return count > 0; }
};

struct Tree {
  std::vector<TreeNode> nodes;
  std::vector<std::uint32_t> references;

  /// Joins the part of a tree that follows this one, shifting its indices.
  void append(const Tree& part);
  /// Edges from the root to the deepest leaf.
  int depth() const;
  /// Expected cost of a random line that meets the root's box.
  double sah_cost(const SahCost& cost) const;
};

}  // namespace strahl
