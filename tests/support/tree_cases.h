// tests/support/tree_cases.h - what tests of tree builders have in common: inputs that mislead
// builders, and the invariants of build/tree.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <tests/support/boxes.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/build/prim_ref.h>
#include <strahl/build/tree.h>

namespace strahl::test {

using Refs = std::vector<PrimRef>;

constexpr SahCost kCost{1.0, 1.0};

inline Aabb box_of(const Refs& refs) {
  Aabb box;
  for (const PrimRef& ref : refs) box.extend(ref.box);
  return box;
}

inline Refs random_refs(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d lo{rng.uniform(), rng.uniform(), rng.uniform()};
    boxes.push_back({lo, lo + Vec3d::all(rng.uniform(0, 0.05))});
  }
  return refs_of(boxes);
}

/// The invariants of tree.h, exact boxes, and the leaf rule.
struct TreeCheck {
  const Tree& tree;
  const Refs& refs;
  std::size_t max_leaf;
  std::size_t next_node = 0, next_reference = 0;

  void run() {
    visit();
    EXPECT_EQ(next_node, tree.nodes.size());
    EXPECT_EQ(next_reference, tree.references.size());
    std::vector<std::uint32_t> sorted = tree.references;
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(sorted.size(), refs.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], i);
  }

  /// Checks the subtree at next_node and returns the box of what lies in it.
  Aabb visit() {
    const TreeNode& node = tree.nodes[next_node++];
    Aabb box;
    if (node.is_leaf()) {
      box = leaf(node);
    } else {
      box = visit();
      EXPECT_EQ(node.right, next_node);
      box.extend(visit());
    }
    EXPECT_EQ(node.box, box);
    return box;
  }

  Aabb leaf(const TreeNode& node) {
    EXPECT_EQ(node.first, next_reference);
    EXPECT_LE(node.count, max_leaf);
    Aabb box;
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const std::uint32_t reference = tree.references[next_reference++];
      EXPECT_TRUE(i == 0 || tree.references[next_reference - 2] < reference);
      box.extend(refs[reference].box);
    }
    return box;
  }
};

inline void expect_equal(const Tree& a, const Tree& b) {
  EXPECT_EQ(a.references, b.references);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.nodes.size(); ++i)
    different += a.nodes[i].box != b.nodes[i].box || a.nodes[i].right != b.nodes[i].right ||
                 a.nodes[i].first != b.nodes[i].first || a.nodes[i].count != b.nodes[i].count;
  EXPECT_EQ(different, 0u);
}

struct Input {
  std::string name;
  Refs refs;
};

constexpr int kMany = 10000;

/// 10,000 boxes each on which a careless builder does not stop or goes deep.
inline std::vector<Input> degenerate_inputs() {
  std::vector<Aabb> same, point, points, series, nested;
  for (int i = 0; i < kMany; ++i) {
    const double x = std::ldexp(1.0, -(i % 240));
    same.push_back({{0, 0, 0}, {1, 2, 3}});
    point.push_back({{1, 2, 3}, {1, 2, 3}});
    points.push_back({Vec3d::all(i / 16), Vec3d::all(i / 16)});
    series.push_back({{x, 0, 0}, {x, 0, 0}});
    nested.push_back({Vec3d::all(-x), Vec3d::all(x)});
  }
  return {{"identical", refs_of(same)},
          {"one point", refs_of(point)},
          {"points on a diagonal", refs_of(points)},
          {"positions 2^-i", refs_of(series)},
          {"sizes 2^-i", refs_of(nested)}};
}

}  // namespace strahl::test
