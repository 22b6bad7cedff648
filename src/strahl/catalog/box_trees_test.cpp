// Trees of boxes as their structures show them, and the end-point overlap of each.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <tests/support/mesh_maker.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/catalog/catalog.h>
#include <strahl/structures/bih/bih.h>
#include <strahl/structures/bvh/bvh.h>
#include <strahl/structures/wide_bvh/wide_bvh.h>

namespace strahl {
namespace {

double overlap(const test::ScenePtr& scene, const std::string& spec) {
  return build(scene, spec)->end_point_overlap({}).value();
}

/// Boxes of children, and of what leaves refer to, lie in their parents' but for `slack`.
void expect_nested(const BoxTree& tree, const Scene& scene, double slack) {
  const std::vector<HierarchyNode>& nodes = tree.nodes.nodes;
  std::vector<bool> is_child(nodes.size(), false), is_held(scene.size(), false);
  for (const HierarchyNode& node : nodes) {
    const Aabb box{node.box.lo - Vec3d::all(slack), node.box.hi + Vec3d::all(slack)};
    for (std::uint32_t c = node.first; c < node.first + node.children; ++c) {
      EXPECT_TRUE(box.contains(nodes[c].box));
      EXPECT_FALSE(is_child[c]);
      is_child[c] = true;
    }
    for (std::uint32_t r = node.first; r < node.first + node.count; ++r) {
      const std::uint32_t reference = tree.nodes.references[r];
      EXPECT_TRUE(box.contains(scene.bounds(reference)));
      is_held[reference] = true;
    }
  }
  EXPECT_EQ(std::count(is_child.begin(), is_child.end(), false), 1);  // the root
  EXPECT_EQ(std::count(is_held.begin(), is_held.end(), false), 0);
}

template <class S>
void expect_tree_of(const Scene& scene, const typename S::Options& options, double slack) {
  const S structure(scene, options, {});
  const std::optional<BoxTree> tree = structure.box_tree();
  ASSERT_TRUE(tree);
  EXPECT_EQ(tree->nodes.nodes.size(), structure.report().nodes);
  EXPECT_EQ(tree->nodes.references.size(), structure.report().references);
  expect_nested(*tree, scene, slack);
}

TEST(BoxTrees, HoldWhatTheirStructuresHold) {
  const test::ScenePtr scene = test::soup(500, 0.1, 1).scene();
  expect_tree_of<Bvh>(*scene, {}, 0.0);
  BihOptions free;
  free.planes = BihPlanes::free;
  expect_tree_of<Bih>(*scene, {}, 1e-6);
  expect_tree_of<Bih>(*scene, free, 1e-6);
  WideBvhOptions eight, sixteen;
  eight.width = WideWidth::eight, sixteen.width = WideWidth::sixteen;
  expect_tree_of<WideBvh>(*scene, eight, 0.0);
  expect_tree_of<WideBvh>(*scene, sixteen, 0.0);
}

TEST(BoxTrees, OfAFarSceneAreInItsCoordinates) {
  test::MeshMaker mesh = test::soup(200, 0.1, 2);
  for (Vec3d& v : mesh.vertices) v = 1e-3 * v + Vec3d{1e6, -2e6, 3e6};
  expect_tree_of<WideBvh>(*mesh.scene(), {}, 1e-9);
}

TEST(BoxTrees, OfFewThingsAreLeaves) {
  const test::ScenePtr scene = test::soup(1, 0.1, 1).scene();
  for (const char* spec : {"bvh", "bih", "wide_bvh"}) EXPECT_EQ(overlap(scene, spec), 0.0) << spec;
  SceneData nothing;
  const auto empty = std::make_shared<const Scene>(std::move(nothing));
  for (const char* spec : {"bvh", "bih", "wide_bvh"}) EXPECT_EQ(overlap(empty, spec), 0.0) << spec;
}

TEST(BoxTrees, OverlapLessWhereBuiltByCost) {
  const test::ScenePtr scene = test::soup(2000, 0.1, 3).scene();
  const double by_cost = overlap(scene, "bvh");
  EXPECT_GT(by_cost, 0.0);
  EXPECT_LT(by_cost, overlap(scene, "bvh:builder=median_cyclic"));
  EXPECT_LT(overlap(scene, "bvh:builder=spatial"), by_cost);
  // The same division; two planes of a node cut less than its whole box.
  EXPECT_LT(by_cost, overlap(scene, "bih:trim=0"));
}

TEST(BoxTrees, OverlapCountsStepsAndTests) {
  const test::ScenePtr scene = test::soup(500, 0.1, 4).scene();
  const auto with = [&](const char* name, const char* costs) {
    return overlap(scene, std::string(name) + costs);
  };
  // The same tree of single primitives, whatever the costs.
  for (const char* name :
       {"bvh:builder=median_longest,leaf_size=1", "bih:split=global,leaf_size=1"}) {
    const double plain = with(name, ""), dear = with(name, ",intersect_cost=3");
    const double both = with(name, ",traverse_cost=2,intersect_cost=6");
    EXPECT_GT(dear, plain) << name;
    EXPECT_LT(dear, 3.0 * plain) << name;
    EXPECT_NEAR(both, dear, 1e-12 * dear) << name;  // in steps
  }
}

TEST(BoxTrees, AreNotThoseOfDividedSpace) {
  const test::ScenePtr scene = test::soup(100, 0.1, 5).scene();
  for (const char* spec : {"brute_force", "grid", "kd_tree", "octree"})
    EXPECT_FALSE(build(scene, spec)->end_point_overlap({})) << spec;
}

}  // namespace
}  // namespace strahl
