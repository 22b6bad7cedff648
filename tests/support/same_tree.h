// tests/support/same_tree.h - two binary trees that must be the same bit by bit.
#pragma once

#include <cstddef>

#include <gtest/gtest.h>

#include <strahl/build/tree.h>

namespace strahl::test {

inline void expect_same_tree(const Tree& a, const Tree& b) {
  EXPECT_EQ(a.references, b.references);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    const TreeNode &s = a.nodes[i], &p = b.nodes[i];
    ASSERT_TRUE(s.box == p.box && s.right == p.right && s.first == p.first && s.count == p.count);
  }
}

}  // namespace strahl::test
