#include <cmath>
#include <tests/support/tree_cases.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/build/linked_tree.h>
#include <strahl/build/object_tree.h>

namespace strahl {
namespace {

using namespace test;

/// Each box beside all that come after it.
LinkedTree chain(const Refs& refs) {
  LinkedTree tree = LinkedTree::of_leaves(refs);
  auto at = static_cast<std::uint32_t>(refs.size() - 1);
  for (auto i = static_cast<std::uint32_t>(refs.size() - 1); i-- > 0;) at = tree.join(i, at);
  return tree;
}

TEST(LinkedTree, BecomesATreeAndBack) {
  Refs refs = random_refs(300, 1);
  const auto splitter = make_sweep_splitter(refs, kCost);
  const Tree tree = build_object_tree(*splitter, refs.size(), box_of(refs), {kCost, 1, 64}, {});
  const Tree again = make_tree(make_linked(tree));
  TreeCheck{again, refs, 1}.run();
  EXPECT_EQ(again.sah_cost(kCost), tree.sah_cost(kCost));
  expect_equal(make_tree(make_linked(again)), again);
}

TEST(LinkedTree, PutsTheLowerCentreLeft) {
  const Refs refs = refs_of({cube({5, 0, 0}, 1), cube({0, 1, 0}, 1)});
  const Tree tree = make_tree(chain(refs));
  EXPECT_EQ(tree.references, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(tree.nodes[0].axis, 0u);
}

TEST(LinkedTree, RefitsUpToWhereNothingChanges) {
  const Refs refs = refs_of({cube({0, 0, 0}, 1), cube({1, 0, 0}, 1), cube({2, 0, 0}, 1)});
  LinkedTree tree = chain(refs);
  tree.nodes[2].box = cube({9, 0, 0}, 1);
  tree.refit_from(tree.nodes[2].parent);
  EXPECT_EQ(tree.nodes[tree.root].box, (Aabb{{0, 0, 0}, {10, 1, 1}}));
}

TEST(LimitDepth, LeavesShallowTreesAlone) {
  const Tree tree = make_tree(chain(random_refs(60, 2)));
  EXPECT_EQ(tree.depth(), 59);
  expect_equal(limit_depth(tree, 59, kCost, {}), tree);
}

TEST(LimitDepth, DividesTheLowestSubtreeAnew) {
  const Refs refs = random_refs(1000, 3);
  const Tree deep = make_tree(chain(refs));
  for (const int max_depth : {10, 18, 64, 500}) {
    const Tree tree = limit_depth(deep, max_depth, kCost, {});
    TreeCheck{tree, refs, 1}.run();
    EXPECT_LE(tree.depth(), max_depth);
    // What is above keeps its shape: one leaf at each level.
    std::size_t leaves_on_top = 0;
    for (std::size_t i = 0; i < tree.nodes.size() && !tree.nodes[i].is_leaf();) {
      const std::size_t left = i + 1, right = tree.nodes[i].right;
      if (!tree.nodes[left].is_leaf() && !tree.nodes[right].is_leaf()) break;
      i = tree.nodes[left].is_leaf() ? right : left, ++leaves_on_top;
    }
    EXPECT_GE(static_cast<int>(leaves_on_top), max_depth - 19);
  }
}

TEST(LimitDepth, TakesChainsOfAnyLength) {
  std::vector<Aabb> boxes;
  for (int i = 0; i < 100000; ++i) boxes.push_back(cube(Vec3d::all(i), 0.5));
  const Refs refs = refs_of(boxes);
  const Tree tree = limit_depth(make_tree(chain(refs)), 64, kCost, {});
  EXPECT_LE(tree.depth(), 64);
  TreeCheck{tree, refs, 1}.run();
}

}  // namespace
}  // namespace strahl
