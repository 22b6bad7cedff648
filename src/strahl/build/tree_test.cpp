#include <tests/support/small_trees.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/build/tree.h>

namespace strahl {
namespace {

using test::cube, test::inner, test::leaf;

/// Two leaves with one and two references.
Tree two_leaves() {
  return {{inner(cube(0, 4), 2), leaf(cube(0, 1), 0, 1), leaf(cube(2, 4), 1, 2)}, {7, 3, 9}};
}

TEST(Tree, AppendShiftsNodesAndReferences) {
  Tree tree{{inner(cube(0, 4), 0), leaf(cube(0, 1), 0, 2)}, {5, 6}};
  tree.append(two_leaves());
  ASSERT_EQ(tree.nodes.size(), 5u);
  EXPECT_EQ(tree.nodes[2].right, 4u);
  EXPECT_EQ(tree.nodes[3].first, 2u);
  EXPECT_EQ(tree.nodes[4].first, 3u);
  EXPECT_EQ(tree.nodes[4].count, 2u);
  EXPECT_EQ(tree.nodes[4].box, cube(2, 4));
  EXPECT_EQ(tree.references, (std::vector<std::uint32_t>{5, 6, 7, 3, 9}));
  EXPECT_EQ(tree.nodes[1].first, 0u);  // what was there stays
}

TEST(Tree, AppendToNothingCopies) {
  Tree tree;
  tree.append(two_leaves());
  EXPECT_EQ(tree.nodes[0].right, 2u);
  EXPECT_EQ(tree.nodes[1].first, 0u);
  EXPECT_EQ(tree.nodes[2].first, 1u);
  tree.append({});
  EXPECT_EQ(tree.nodes.size(), 3u);
}

TEST(Tree, DepthCountsEdgesToTheDeepestLeaf) {
  EXPECT_EQ((Tree{{leaf(cube(0, 1), 0, 1)}, {0}}.depth()), 0);
  EXPECT_EQ(two_leaves().depth(), 1);
  const Aabb box = cube(0, 1);
  // Root with a leaf on the left, and on the right an inner node whose left child is inner.
  const Tree lopsided{{inner(box, 2), leaf(box, 0, 1), inner(box, 6), inner(box, 5),
                       leaf(box, 1, 1), leaf(box, 2, 1), leaf(box, 3, 1)},
                      {0, 1, 2, 3}};
  EXPECT_EQ(lopsided.depth(), 3);
}

TEST(Tree, CostWeighsNodesByTheirShareOfTheRootsArea) {
  const SahCost cost{2.0, 5.0};
  EXPECT_EQ((Tree{{leaf(cube(0, 1), 0, 3)}, {0, 1, 2}}.sah_cost(cost)), 15.0);
  // Half areas 48, 3 and 12.
  EXPECT_EQ(two_leaves().sah_cost(cost), 2.0 + 5.0 * 3.0 / 48.0 + 2 * 5.0 * 12.0 / 48.0);
}

TEST(Tree, CostCountsEveryNodeWhereTheRootHasNoArea) {
  Tree tree = two_leaves();
  for (TreeNode& node : tree.nodes) node.box = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(tree.sah_cost({2.0, 5.0}), 2.0 + 3 * 5.0);
}

}  // namespace
}  // namespace strahl
