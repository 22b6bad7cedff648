#include <tests/support/small_trees.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/build/collapse.h>
#include <strahl/build/hierarchy.h>

namespace strahl {
namespace {

using test::cube, test::inner, test::leaf;

/// A root whose left child is inner; three leaves, the middle one with two references.
Tree three_leaves() {
  return {{inner(cube(0, 4), 4), inner(cube(0, 2), 3), leaf(cube(0, 1), 0, 1),
           leaf(cube(1, 2), 1, 2), leaf(cube(3, 4), 3, 1)},
          {7, 3, 9, 1}};
}

TEST(Hierarchy, OfATreeHasItsNodesInPairs) {
  const Hierarchy made = make_hierarchy(three_leaves());
  ASSERT_EQ(made.nodes.size(), 5u);
  EXPECT_EQ(made.nodes[0].first, 1u);
  EXPECT_EQ(made.nodes[0].children, 2u);
  EXPECT_EQ(made.nodes[1].box, cube(0, 2));
  EXPECT_EQ(made.nodes[1].first, 3u);
  EXPECT_EQ(made.nodes[2].count, 1u);
  EXPECT_EQ(made.references[made.nodes[2].first], 1u);
  EXPECT_EQ(made.nodes[4].count, 2u);
  EXPECT_EQ(made.references, (std::vector<std::uint32_t>{7, 3, 9, 1}));
  EXPECT_EQ(made.depth(), 2);
  EXPECT_DOUBLE_EQ(made.sah_cost({1.0, 2.0}), three_leaves().sah_cost({1.0, 2.0}));
}

TEST(Hierarchy, OfACollapseHasItsWideNodes) {
  const Tree tree = three_leaves();
  // Dear nodes and cheap leaves of at most two: all three leaves hang below the root.
  const Collapse collapse(tree, {4, 2, 10.0, 1.0, 0.0}, {});
  const Hierarchy made = make_hierarchy(tree, collapse);
  ASSERT_EQ(made.nodes.size(), 4u);
  EXPECT_EQ(made.nodes[0].children, 3u);
  EXPECT_EQ(made.depth(), 1);
  EXPECT_EQ(made.children(made.nodes[0])[1].box, cube(1, 2));
  EXPECT_EQ(made.children(made.nodes[0])[1].count, 2u);
}

TEST(Hierarchy, ARootMayBeALeafWithAscendingReferences) {
  const Hierarchy made = make_hierarchy(Tree{{leaf(cube(0, 1), 0, 3)}, {5, 2, 4}});
  ASSERT_EQ(made.nodes.size(), 1u);
  EXPECT_TRUE(made.nodes[0].is_leaf());
  EXPECT_EQ(made.references, (std::vector<std::uint32_t>{2, 4, 5}));
  EXPECT_EQ(made.depth(), 0);
}

TEST(Hierarchy, PartsOfOneThingThatMeetInALeafAreOneReference) {
  Tree tree;
  const Aabb left{{0, 0, 0}, {1, 1, 1}}, right{{1, 0, 0}, {2, 1, 1}};
  tree.nodes = {{Aabb::join(left, right), 2, 0, 0, 0}, {left, 0, 0, 1, 0}, {right, 0, 1, 1, 0}};
  tree.references = {5, 5};
  CollapseRules rules;
  rules.width = 2, rules.max_leaf = 4;
  const Hierarchy hierarchy = make_hierarchy(tree, Collapse(tree, rules, {}));
  ASSERT_EQ(hierarchy.nodes.size(), 1u);
  EXPECT_EQ(hierarchy.nodes[0].count, 1u);
  EXPECT_EQ(hierarchy.references, std::vector<std::uint32_t>{5});
}

}  // namespace
}  // namespace strahl
