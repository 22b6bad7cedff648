// tests/support/small_trees.h - nodes for trees written by hand.
#pragma once

#include <cstdint>

#include <strahl/build/tree.h>

namespace strahl::test {

inline Aabb cube(double lo, double hi) { return {Vec3d::all(lo), Vec3d::all(hi)}; }
inline TreeNode inner(const Aabb& box, std::uint32_t right) { return {box, right, 0, 0}; }
inline TreeNode leaf(const Aabb& box, std::uint32_t first, std::uint32_t count) {
  return {box, 0, first, count};
}

}  // namespace strahl::test
