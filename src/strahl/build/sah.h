// build/sah.h - the surface area heuristic: the expected cost of a random line in a tree.
//
// Source: [MacDonaldBooth1990]. A line that crosses a convex box crosses a convex box inside it
//   with probability area(inner) / area(outer); half areas do as well.
// Units: any, as long as they are the same for traversal and intersection; only the ratio decides.
// Thread safety: pure functions.
#pragma once

#include <cstddef>

namespace strahl {

/// What one step of the traversal and one primitive test cost.
struct SahCost {
  double traverse = 1.0;
  double intersect = 1.0;
};

/// Cost of a leaf with `count` primitives.
constexpr double sah_leaf_cost(const SahCost& cost, std::size_t count) {
  return cost.intersect * static_cast<double>(count);
}

/// Cost of a node whose children are leaves.
/// @param share_left,share_right probability that a line in the node crosses the child
constexpr double sah_split_cost(const SahCost& cost, double share_left, std::size_t left,
                                double share_right, std::size_t right) {
  return cost.traverse + share_left * sah_leaf_cost(cost, left) +
         share_right * sah_leaf_cost(cost, right);
}

/// area / whole; 1 where the whole has no area: every line that meets it meets its parts.
constexpr double sah_share(double area, double whole) { return whole > 0.0 ? area / whole : 1.0; }

/// `cost`, lowered where a split cuts off empty space.
/// @param empty_bonus 0 for none, up to 1: the part of the cost that is forgiven
constexpr double sah_with_empty_bonus(double cost, double empty_bonus, std::size_t left,
                                      std::size_t right) {
  return left == 0 || right == 0 ? cost * (1.0 - empty_bonus) : cost;
}

}  // namespace strahl
