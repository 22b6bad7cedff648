// tests/support/hierarchy_check.h - the invariants of build/hierarchy.h.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/build/hierarchy.h>
#include <strahl/build/prim_ref.h>

namespace strahl::test {

/// Parts of boxes in leaves cover them: by volume, and to all sides.
inline void check_parts(const Hierarchy& tree, const std::vector<PrimRef>& refs) {
  std::vector<Aabb> covered(refs.size());
  std::vector<double> volume(refs.size(), 0.0);
  const auto volume_of = [](const Aabb& box) {
    const Vec3d e = box.extent();
    return e.x * e.y * e.z;
  };
  for (const HierarchyNode& node : tree.nodes)
    for (std::uint32_t r = node.first; r < node.first + node.count; ++r) {
      const std::uint32_t i = tree.references[r];
      const Aabb part = Aabb::intersection(node.box, refs[i].box);
      covered[i].extend(part), volume[i] += volume_of(part);
    }
  for (std::size_t i = 0; i < refs.size(); ++i) {
    EXPECT_EQ(covered[i], refs[i].box);
    EXPECT_GE(volume[i], (1.0 - 1e-9) * volume_of(refs[i].box)) << i;
  }
}

/// Layout, exact boxes, ascending leaves within their bound; every reference once, 0..n-1.
/// @param is_cut references may be in several leaves, the box of a leaf holds parts of them
inline void check_hierarchy(const Hierarchy& tree, const std::vector<PrimRef>& refs,
                            std::size_t max_leaf, int max_children, bool is_cut = false) {
  std::vector<Aabb> below(tree.nodes.size());
  std::vector<std::uint32_t> seen(refs.size(), 0), parents(tree.nodes.size(), 0);
  std::size_t broken = 0;
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    const HierarchyNode& node = tree.nodes[i];
    for (std::uint32_t c = node.first; c < node.first + node.children; ++c) {
      below[i].extend(below.at(c));
      ++parents.at(c);
      broken += c <= i;
    }
    for (std::uint32_t r = node.first; node.is_leaf() && r < node.first + node.count; ++r) {
      below[i].extend(refs.at(tree.references.at(r)).box);
      ++seen[tree.references[r]];
      broken += r > node.first && tree.references[r - 1] >= tree.references[r];
    }
    const bool is_sound =
        node.is_leaf() ? node.count >= 1 && node.count <= max_leaf
                       : node.children >= 2 && std::cmp_less_equal(node.children, max_children);
    if (is_cut && node.is_leaf()) {
      broken += !below[i].contains(node.box);
      below[i] = node.box;
    }
    broken += !is_sound || node.box != below[i];
  }
  EXPECT_EQ(broken, 0u);
  const auto whole = std::count(seen.begin(), seen.end(), 1u);
  const auto none = std::count(seen.begin(), seen.end(), 0u);
  EXPECT_EQ(is_cut ? std::ssize(refs) - none : whole, std::ssize(refs));
  if (is_cut) check_parts(tree, refs);
  EXPECT_EQ(std::count(parents.begin(), parents.end(), 1u),
            static_cast<std::ptrdiff_t>(tree.nodes.size()) - 1);
  EXPECT_EQ(parents.at(0), 0u);
}

}  // namespace strahl::test
