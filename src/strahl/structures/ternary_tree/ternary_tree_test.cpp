#include <functional>
#include <string>
#include <tests/support/mesh_maker.h>

#include <gtest/gtest.h>

#include <strahl/catalog/catalog.h>
#include <strahl/structures/ternary_tree/oversize.h>
#include <strahl/structures/ternary_tree/ternary_build.h>
#include <strahl/structures/ternary_tree/ternary_tree.h>

namespace strahl {
namespace {

using test::MeshMaker;
using test::ScenePtr;
using test::soup;

/// Dust under slanted sheets that cross the whole cell: no plane separates them from the dust.
ScenePtr dust_under_sheets(std::size_t dust, int sheets) {
  MeshMaker mesh = soup(dust, 0.005, 1);
  for (int i = 0; i < sheets; ++i) {
    const double z = 0.1 * i;
    mesh.triangle({-0.1, -0.1, z}, {1.1, -0.1, 1 - z}, {1.1, 1.1, z});
  }
  return mesh.scene();
}

std::size_t filters_of(const KdArrays& tree) {
  std::size_t filters = 0;
  for (const KdNode& node : tree.nodes) filters += node.is_filter();
  return filters;
}

KdArrays nodes_of(const ScenePtr& scene, const TernaryTreeOptions& options) {
  BuildReport report;
  return build_ternary_tree(*scene, make_prim_refs(*scene, {}), scene->total_bounds(), options, {},
                            report);
}

TEST(Oversize, RulesLookAtSidesAtAreaAndAtTheMedian) {
  const Aabb cell{{0, 0, 0}, {10, 10, 10}};
  const std::vector<Fragment> fragments{
      {{0, 0, 0}, {9, 9, 0}, 0},   // a floor: long on two axes, area 81 of 300
      {{0, 0, 0}, {9, 1, 1}, 1},   // a beam: long on one axis, area 19
      {{0, 0, 0}, {10, 7, 7}, 2},  // a block: area 189
      {{0, 0, 0}, {1, 1, 1}, 3},   // area 3
      {{5, 5, 5}, {6, 6, 6}, 4},   // area 3
  };
  TernaryTreeOptions options;
  options.threshold = 0.5;
  using Flags = std::vector<bool>;
  options.rule = OversizeRule::sides;
  EXPECT_EQ(find_oversized(fragments, cell, options), (Flags{1, 0, 1, 0, 0}));
  options.rule = OversizeRule::area;
  EXPECT_EQ(find_oversized(fragments, cell, options), (Flags{0, 0, 1, 0, 0}));
  options.threshold = 0.27;
  EXPECT_EQ(find_oversized(fragments, cell, options), (Flags{1, 0, 1, 0, 0}));
  options.rule = OversizeRule::median, options.median_factor = 4;  // the median is 19
  EXPECT_EQ(find_oversized(fragments, cell, options), (Flags{1, 0, 1, 0, 0}));
}

TEST(Oversize, AFlatCellHasNoThirdSide) {
  const std::vector<Fragment> fragments{{{0, 0, 1}, {9, 1, 1}, 0}, {{0, 0, 1}, {9, 9, 1}, 1}};
  TernaryTreeOptions options;
  options.rule = OversizeRule::sides;
  EXPECT_EQ(find_oversized(fragments, {{0, 0, 1}, {10, 10, 1}}, options),
            (std::vector<bool>{false, true}));
}

TEST(TernaryTree, TakesOutWhatWouldBeOnBothSides) {
  const ScenePtr scene = dust_under_sheets(2000, 6);
  const auto binary = build(scene, "kd_tree"), ternary = build(scene, "ternary_tree");
  EXPECT_NO_THROW(ternary->validate());
  EXPECT_GT(filters_of(nodes_of(scene, {})), 0u);
  EXPECT_LT(ternary->report().references, binary->report().references);
}

TEST(TernaryTree, AnswersLikeBruteForceInAnyOrderWithListsAndTrees) {
  const ScenePtr scene = dust_under_sheets(300, 11);
  Rng rng(8);
  const auto point = [&] { return Vec3d{rng.uniform(), rng.uniform(), rng.uniform(-1, 2)}; };
  std::vector<Ray> rays;
  for (int i = 0; i < 500; ++i) rays.push_back({point(), point() - point()});
  AllHits expected, got;
  build(scene, "brute_force")->all_hits(make_batch(rays), expected);
  for (const std::string rule : {"area", "sides", "median"})
    for (const char* keep : {"list", "tree"})
      for (const char* order : {"first", "last"}) {
        const auto tree = build(scene, "ternary_tree:decide=always,threshold=0.3,rule=" + rule +
                                           ",keep=" + keep + ",order=" + order);
        ASSERT_NO_THROW(tree->validate()) << tree->spec();
        tree->all_hits(make_batch(rays), got);
        EXPECT_EQ(got.splits, expected.splits) << tree->spec();
      }
}

TEST(TernaryTree, IsAKdTreeWhereNothingIsOversized) {
  const ScenePtr scene = soup(500, 0.01, 2).scene();
  EXPECT_EQ(build(scene, "ternary_tree:rule=median,median_factor=1000000")->tree_hash(),
            build(scene, "kd_tree:retract=off,empty_cut=0")->tree_hash());
}

TEST(TernaryTree, DividesTheRestAsIfTheOversizedWereNotThere) {
  MeshMaker mesh = soup(1000, 0.005, 9);
  const ScenePtr dust = mesh.scene();
  for (const double z : {0.2, 0.3, 0.4})  // within the box of the dust
    mesh.triangle({0.02, 0.02, z}, {0.98, 0.02, 1 - z}, {0.98, 0.98, z + 0.3});
  TernaryTreeOptions options;
  options.decide = OversizeDecision::always, options.threshold = 0.4, options.max_depth = 60;
  const ScenePtr both = mesh.scene();
  ASSERT_EQ(both->total_bounds(), dust->total_bounds());
  const KdArrays whole = nodes_of(both, options), rest = nodes_of(dust, options);
  ASSERT_EQ(whole.nodes[1].count(), 3u);
  ASSERT_EQ(whole.nodes.size(), rest.nodes.size() + 2);
  for (std::size_t i = 0; i < rest.nodes.size(); ++i) {
    const KdNode &a = whole.nodes[i + 2], &b = rest.nodes[i];
    ASSERT_EQ(a.is_leaf(), b.is_leaf());
    if (a.is_leaf() || a.is_filter()) continue;
    ASSERT_EQ(a.axis(), b.axis());
    ASSERT_EQ(a.plane(), b.plane());
  }
}

TEST(TernaryTree, KeepsFewAsAListAndManyAsATree) {
  TernaryTreeOptions options;
  options.decide = OversizeDecision::always;
  options.threshold = 0.3;      // every sheet is oversized
  options.intersect_cost = 20;  // any division pays, so only lists stay whole
  const auto first_oversized_is_list = [&](int sheets, OversizeKeep keep, int list_max) {
    options.keep = keep, options.list_max = list_max;
    const KdArrays tree = nodes_of(dust_under_sheets(1000, sheets), options);
    EXPECT_TRUE(tree.nodes[0].is_filter());
    return tree.nodes[1].is_leaf();
  };
  EXPECT_TRUE(first_oversized_is_list(8, OversizeKeep::automatic, 8));
  EXPECT_FALSE(first_oversized_is_list(9, OversizeKeep::automatic, 8));
  EXPECT_TRUE(first_oversized_is_list(9, OversizeKeep::list, 8));
  EXPECT_FALSE(first_oversized_is_list(8, OversizeKeep::tree, 8));
}

TEST(TernaryTree, DecidesByExpectedCost) {
  TernaryTreeOptions by_cost, always;
  by_cost.rule = always.rule = OversizeRule::median;
  by_cost.median_factor = always.median_factor = 4;
  always.decide = OversizeDecision::always;
  const ScenePtr scene = soup(2000, 0.05, 3).scene();  // none large in its cell, some beside others
  EXPECT_LT(filters_of(nodes_of(scene, by_cost)), filters_of(nodes_of(scene, always)));
  const Aabb root = scene->total_bounds();
  EXPECT_LT(report_kd_tree(nodes_of(scene, by_cost), root, {1.0, 0.7}).sah_cost,
            report_kd_tree(nodes_of(scene, always), root, {1.0, 0.7}).sah_cost);
}

TEST(TernaryTree, FiltersNothingWithinAnOversizedTree) {
  TernaryTreeOptions options;
  options.rule = OversizeRule::median, options.median_factor = 1;  // half of any set
  options.keep = OversizeKeep::tree, options.decide = OversizeDecision::always;
  const KdArrays tree = nodes_of(dust_under_sheets(1000, 3), options);
  ASSERT_TRUE(tree.nodes[0].is_filter());
  ASSERT_FALSE(tree.nodes[1].is_leaf());
  for (std::size_t i = 1; i < tree.nodes[0].right(); ++i) EXPECT_FALSE(tree.nodes[i].is_filter());
}

TEST(TernaryTree, AGoodOccluderFirstSparesTheRest) {
  MeshMaker mesh = soup(2000, 0.01, 4);
  mesh.quad({-0.1, -0.1, -0.02}, {1.2, 0, 0.04}, {0, 1.2, 0});  // slanted: cut by many planes
  const ScenePtr scene = mesh.scene();
  std::vector<Ray> rays;
  Rng rng(5);
  for (int i = 0; i < 300; ++i) rays.push_back({{rng.uniform(), rng.uniform(), -1}, {0.1, 0, 1}});
  BatchContext counting;
  counting.count_work = true;
  std::vector<std::uint8_t> any(rays.size());
  const auto steps = [&](const char* spec) {
    return build(scene, spec)->any_hit(make_batch(rays), any, counting).counters.traversal_steps;
  };
  EXPECT_LT(2 * steps("ternary_tree:decide=always,rule=sides,order=first"),
            steps("ternary_tree:decide=always,rule=sides,order=last"));
}

/// A valid tree and what its check is told; tests damage copies.
struct CheckedTree {
  ScenePtr scene = dust_under_sheets(50, 3);
  KdArrays tree;
  Aabb root = scene->total_bounds();
  BuildReport report;

  CheckedTree() {
    TernaryTreeOptions options;
    options.decide = OversizeDecision::always;
    tree = nodes_of(scene, options);
    report = report_kd_tree(tree, root, {1.0, 0.7});
  }
  void check(bool may_filter = true) const {
    validate_kd_tree(tree, {"ternary_tree", root, 64, {1.0, 0.7}, may_filter, report}, *scene);
  }
  void expect_broken(const std::function<void(CheckedTree&)>& damage) const {
    CheckedTree damaged = *this;
    damage(damaged);
    EXPECT_THROW(damaged.check(), std::logic_error);
  }
};

TEST(TernaryTree, ValidateNoticesDamage) {
  const CheckedTree good;
  ASSERT_NO_THROW(good.check());
  ASSERT_TRUE(good.tree.nodes[0].is_filter());
  ASSERT_EQ(good.tree.nodes[1].count(), 3u);
  const std::uint32_t rest = good.tree.nodes[0].right();
  EXPECT_THROW(good.check(false), std::logic_error);                     // a kd-tree has no filters
  good.expect_broken([](CheckedTree& b) { b.tree.references[0] = 0; });  // a sheet is lost
  good.expect_broken([](CheckedTree& b) { std::swap(b.tree.references[0], b.tree.references[1]); });
  good.expect_broken([](CheckedTree& b) { b.tree.nodes[0].link_right(1); });  // rest is a leaf
  good.expect_broken([&](CheckedTree& b) { b.tree.nodes[0].link_right(rest + 1); });
  good.expect_broken([&](CheckedTree& b) { b.tree.nodes[rest] = KdNode::filter(); });
  good.expect_broken([&](CheckedTree& b) {  // a sheet is also in a leaf of the rest
    for (std::size_t i = rest; i < b.tree.nodes.size(); ++i)
      if (b.tree.nodes[i].is_leaf() && b.tree.nodes[i].count() == 1) {
        b.tree.nodes[i] = KdNode::leaf(b.tree.references[0], 1);
        return;
      }
  });
  good.expect_broken([](CheckedTree& b) { ++b.report.references; });
  good.expect_broken([](CheckedTree& b) { b.report.sah_cost *= 1.01; });
}

TEST(TernaryTree, StopsOnTenThousandEqualTriangles) {
  MeshMaker mesh;
  for (int i = 0; i < 10000; ++i) mesh.triangle({0, 0, 0}, {1, 0.25, 0}, {0, 1, 0.5});
  const ScenePtr scene = mesh.scene();
  for (const char* spec : {"ternary_tree", "ternary_tree:decide=always,rule=median,median_factor=1",
                           "ternary_tree:rule=sides,keep=tree,split=sah_binned"}) {
    const auto tree = build(scene, spec);
    EXPECT_NO_THROW(tree->validate());
    EXPECT_LE(tree->report().references, 40000u);
    EXPECT_EQ(tree->closest_hit({{0.2, 0.3, -1}, {0, 0, 1}}).id.prim, 0u);
  }
}

TEST(TernaryTree, StaysWithinDepthAndGrowth) {
  const ScenePtr scene = dust_under_sheets(1000, 20);
  for (const int depth : {1, 2, 3, 5, 9}) {
    const auto tree = build(scene, "ternary_tree:decide=always,max_depth=" + std::to_string(depth));
    EXPECT_NO_THROW(tree->validate());
    EXPECT_LE(tree->report().depth, static_cast<std::uint64_t>(depth));
  }
  const auto tree = build(scene, "ternary_tree:max_growth=1.5");
  EXPECT_LE(tree->report().references, 1530u);
}

TEST(TernaryTree, HoldsNothingWhenThereIsNothingToHit) {
  const auto tree = build(MeshMaker().scene(), "ternary_tree");
  EXPECT_NO_THROW(tree->validate());
  EXPECT_EQ(tree->report().empty_leaves, 1u);
  EXPECT_FALSE(tree->closest_hit({{-1, 0.1, 0.1}, {1, 0, 0}}).is_hit());
}

TEST(TernaryTree, IsTheSameTreeForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const ScenePtr scene = dust_under_sheets(30000, 9);
  for (const char* spec : {"ternary_tree", "ternary_tree:decide=always,split=sah_binned"}) {
    const auto serial = build(scene, spec);
    BuildContext context;
    context.executor = Executor::with_threads(4);
    const auto parallel = build(scene, spec, context);
    EXPECT_EQ(parallel->tree_hash(), serial->tree_hash());
    EXPECT_EQ(parallel->report().sah_cost, serial->report().sah_cost);
  }
}

TEST(TernaryTree, KeepsToTheMemoryLimit) {
  const ScenePtr scene = soup(5000, 0.5, 6).scene();
  BuildContext context;
  context.memory_limit = 1'000'000;
  try {
    build(scene, "ternary_tree", context);
    ADD_FAILURE() << "built beyond the limit";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::resource);
  }
}

TEST(TernaryTree, CanBeCancelledWhileItIsBuilt) {
  const ScenePtr scene = dust_under_sheets(40000, 5);
  BuildContext context;
  double last = 0.0;
  context.progress = [&](double fraction, std::string_view stage) {
    if (stage == "building") last = fraction;
    return stage != "building" || fraction < 0.5;
  };
  EXPECT_THROW(build(scene, "ternary_tree", context), Error);
  EXPECT_GE(last, 0.5);
  EXPECT_LT(last, 0.6);
}

TEST(TernaryTree, RefusesBadOptionsByName) {
  const ScenePtr scene = soup(1, 0.1, 7).scene();
  for (const char* spec :
       {"ternary_tree:rule=volume", "ternary_tree:threshold=0", "ternary_tree:median_factor=0.5",
        "ternary_tree:keep=none", "ternary_tree:list_max=-1", "ternary_tree:order=near"})
    EXPECT_THROW(build(scene, spec), Error) << spec;
}

}  // namespace
}  // namespace strahl
