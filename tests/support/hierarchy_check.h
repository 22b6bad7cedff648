// tests/support/hierarchy_check.h - the invariants of build/hierarchy.h.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/build/hierarchy.h>
#include <strahl/build/prim_ref.h>

namespace strahl::test {

/// Layout, exact boxes, ascending leaves within their bound; every reference once, 0..n-1.
inline void check_hierarchy(const Hierarchy& tree, const std::vector<PrimRef>& refs,
                            std::size_t max_leaf, std::uint32_t max_children) {
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
    const bool is_sound = node.is_leaf() ? node.count >= 1 && node.count <= max_leaf
                                         : node.children >= 2 && node.children <= max_children;
    broken += !is_sound || node.box != below[i];
  }
  EXPECT_EQ(broken, 0u);
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1u), static_cast<std::ptrdiff_t>(refs.size()));
  EXPECT_EQ(std::count(parents.begin(), parents.end(), 1u),
            static_cast<std::ptrdiff_t>(tree.nodes.size()) - 1);
  EXPECT_EQ(parents.at(0), 0u);
}

}  // namespace strahl::test
