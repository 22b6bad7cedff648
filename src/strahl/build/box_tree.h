// build/box_tree.h - the tree of a structure as its measures see it: boxes, and what visits cost.
//
// Thread safety: values.
#pragma once

#include <strahl/build/hierarchy.h>

namespace strahl {

/// What a visit costs: of an inner node, of a leaf, of each reference in it.
struct VisitCost {
  double inner = 1.0, leaf = 0.0, reference = 1.0;

  double of(const HierarchyNode& node) const {
    return node.is_leaf() ? leaf + reference * node.count : inner;
  }
};

/// A node may have one child here.
struct BoxTree {
  Hierarchy nodes;
  VisitCost cost;
};

}  // namespace strahl
