// structures/bvh/child_order.h - children in the order of their centres, for visits by the ray's
// direction.
//
// Method:     of each node the axis is found along which the centres of its children's boxes differ
//             most, and the children are put in ascending order along it. A ray visits them in that
//             order, or backwards where its direction is negative along the axis, without comparing
//             entries. Equal centres stay in the order of the tree.
// Thread safety: pure functions.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <strahl/build/hierarchy.h>

namespace strahl {

/// Where the nodes of a hierarchy went.
struct ChildOrder {
  std::vector<std::uint8_t> axes;   ///< per node as it is now, 0 for leaves
  std::vector<std::uint32_t> from;  ///< its number before

  /// What belongs to the nodes, one each, in their new order.
  template <class T>
  std::vector<T> applied_to(std::vector<T> things) const {
    std::vector<T> moved;
    moved.reserve(things.size());
    for (const std::uint32_t i : from) moved.push_back(std::move(things[i]));
    return moved;
  }
};

/// Puts the children of all nodes in order. O(nodes * log arity).
ChildOrder order_children(Hierarchy& hierarchy);

}  // namespace strahl
