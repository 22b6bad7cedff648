// build/hierarchy.h - the neutral tree of any arity that structures over bounding volumes consume.
//
// Layout: the children of a node are consecutive and come after it; the root is node 0.
// Invariants: a node has either children (two or more, except that a root may be a leaf) or
//   references (one or more); a node's box encloses its children's; leaves own consecutive runs of
//   `references`, which ascend inside each leaf. A primitive that was cut is in several leaves.
// Thread safety: values.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <strahl/build/sah.h>
#include <strahl/build/tree.h>

namespace strahl {

class Collapse;

/// Children from `first` of the nodes, or references from `first`.
struct HierarchyNode {
  Aabb box;
  std::uint32_t first = 0;
  std::uint32_t children = 0;  ///< 0 in leaves
  std::uint32_t count = 0;     ///< references; 0 in inner nodes

  bool is_leaf() const { return children == 0; }
};

struct Hierarchy {
  std::vector<HierarchyNode> nodes;  ///< empty when there is nothing
  std::vector<std::uint32_t> references;

  std::span<const HierarchyNode> children(const HierarchyNode& node) const {
    if (node.children == 0) return {};  // `first` of a leaf is no node
    return std::span(nodes).subspan(node.first, node.children);
  }
  /// Edges from the root to the deepest leaf.
  int depth() const;
  /// Expected cost of a random line that meets the root's box.
  double sah_cost(const SahCost& cost) const;
};

/// The same nodes, pairs of children in depth-first order. O(nodes).
Hierarchy make_hierarchy(const Tree& tree);
/// The binary tree that a hierarchy of pairs and of single references is. O(nodes).
Tree make_binary(const Hierarchy& hierarchy);
/// The wide nodes and blocks that the collapse chose of the tree. O(nodes).
Hierarchy make_hierarchy(const Tree& tree, const Collapse& collapse);

}  // namespace strahl
