// How kd-trees are built: builders that agree, rules that hold for every node.
#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <tests/support/mesh_maker.h>
#include <tests/support/shared.h>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>
#include <strahl/structures/kd_tree/kd_build.h>

namespace strahl {
namespace {

using test::is_full_run;
using test::MeshMaker;
using test::ScenePtr;
using test::soup;
using test::walls;

/// Three flat sheets of tiles, a cluster of equal triangles, a fan and slivers.
ScenePtr mixture() {
  MeshMaker mesh = soup(300, 0.1, 21);
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j)
      for (const double z : {0.1, 0.25, 0.75})
        mesh.quad({0.1 * i, 0.1 * j, z}, {0.1, 0, 0}, {0, 0.1, 0});
  for (int i = 0; i < 100; ++i) {
    mesh.triangle({0.5, 0.5, 0.5}, {0.75, 0.5, 0.5}, {0.5, 0.75, 0.625});
    const double a = 0.01 * i;
    mesh.triangle({0, 0, 0}, {1, a, 0.5}, {1, a + 0.01, 0.5});
    mesh.triangle({a, 0, 0}, {a + 1e-7, 1, 1}, {a + 1e-7, 1, 0.9});
  }
  return mesh.scene();
}

/// Rooms behind each other, full walls between them, furniture at their ends.
ScenePtr enfilade() {
  MeshMaker mesh;
  Rng rng(31);
  for (int room = 0; room < 8; ++room) {
    if (room > 0) mesh.quad({1.0 * room, 0, 0}, {0, 1, 0}, {0, 0, 1});
    for (int i = 0; i < 40; ++i) {
      const Vec3d at{room + rng.uniform(0.05, 0.9), rng.uniform(0.0, 0.9), rng.uniform(0.0, 0.9)};
      mesh.triangle(at, at + Vec3d{0.05, 0, 0}, at + Vec3d{0, 0.05, 0.05});
    }
  }
  mesh.quad({0, 0, 0}, {8, 0, 0}, {0, 1, 0});
  mesh.quad({0, 0, 1}, {8, 0, 0}, {0, 1, 0});
  return mesh.scene();
}

std::vector<ScenePtr> scenes() {
  MeshMaker nothing, equal, flat;
  for (int i = 0; i < 50; ++i) {
    equal.triangle({0, 0, 0}, {1, 0.25, 0}, {0, 1, 0.5});
    flat.triangle({0.1 * i, 0, 0.3}, {0.1 * i + 0.3, 1, 0.3}, {0.1 * i, 0.7, 0.3});
  }
  return {nothing.scene(),
          soup(1, 0.5, 22).scene(),
          equal.scene(),
          flat.scene(),
          walls(4, 1.0, {0, 0, 0}).scene(),
          walls(4, 0.1, {0.3, -0.7, 1.0 / 3.0}).scene(),
          walls(3, 0.75, {1e7, -1e7, 3e6}).scene(),
          walls(2, 1e60, {1e60, 0, -3e60}).scene(),
          soup(500, 0.3, 23).scene(),
          mixture(),
          soup(is_full_run() ? 20000 : 3000, 0.01, 24).scene()};
}

/// Rules of building; each changes trees.
const char* const kRules[] = {
    "",
    ",clip=off",
    ",bad_splits=8,intersect_cost=80",
    ",empty_cut=0.1,walls=on",
    ",min_volume=0.0001,retract=off",
    ",cost_stop=off,max_leaf=2,max_depth=12,max_growth=4",
};

std::uint64_t hash_of(const ScenePtr& scene, const std::string& spec) {
  return build(scene, spec)->tree_hash();
}

TEST(KdBuild, ThreeExactBuildersMakeTheSameTree) {
  const std::vector<ScenePtr> all = scenes();
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const std::string rules : kRules) {
      if (all[i]->size() > 1000 && !rules.empty() && !is_full_run()) continue;
      SCOPED_TRACE("scene " + std::to_string(i) + rules);
      const auto spliced = hash_of(all[i], "kd_tree:split=sah_sweep" + rules);
      EXPECT_EQ(hash_of(all[i], "kd_tree:split=sah_sort" + rules), spliced);
      EXPECT_EQ(hash_of(all[i], "kd_tree:split=sah_naive" + rules), spliced);
    }
}

TEST(KdBuild, ThreeExactBuildersLookAheadAlike) {
  for (const ScenePtr& scene :
       {soup(200, 0.2, 35).scene(), walls(3, 0.1, {0.3, -0.7, 0}).scene()}) {
    const auto spliced = hash_of(scene, "kd_tree:look_ahead=1");
    EXPECT_EQ(hash_of(scene, "kd_tree:split=sah_sort,look_ahead=1"), spliced);
    EXPECT_EQ(hash_of(scene, "kd_tree:split=sah_naive,look_ahead=1"), spliced);
    EXPECT_NE(hash_of(scene, "kd_tree"), spliced);
  }
}

TEST(KdBuild, EveryRuleMakesAnotherValidTree) {
  for (const ScenePtr& scene : {mixture(), enfilade()}) {
    std::set<std::uint64_t> trees{hash_of(scene, "kd_tree")};
    for (const char* spec :
         {"kd_tree:empty_cut=0.1", "kd_tree:look_ahead=1", "kd_tree:min_volume=0.1",
          "kd_tree:cost_stop=off", "kd_tree:split=sah_binned,bins=8", "kd_tree:retract=off",
          "kd_tree:split=middle,cost_stop=off,max_leaf=2,max_depth=16,axis=round_robin"}) {
      const auto tree = build(scene, spec);
      EXPECT_NO_THROW(tree->validate()) << spec;
      EXPECT_TRUE(trees.insert(tree->tree_hash()).second) << spec;
    }
  }
  const ScenePtr few = soup(60, 0.3, 36).scene();
  std::set<std::uint64_t> trees;
  for (const char* spec :
       {"kd_tree:look_ahead=1", "kd_tree:look_ahead=2", "kd_tree:look_ahead=3"}) {
    const auto tree = build(few, spec);
    EXPECT_NO_THROW(tree->validate()) << spec;
    EXPECT_TRUE(trees.insert(tree->tree_hash()).second) << spec;
  }
}

TEST(KdBuild, IsTheSameTreeForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const ScenePtr many = soup(17000, 0.005, 25).scene(), fewer = soup(5000, 0.01, 25).scene();
  for (const char* spec :
       {"kd_tree", "kd_tree:split=sah_sort", "kd_tree:split=sah_binned,bins=16",
        "kd_tree:empty_cut=0.05", "kd_tree:walls=on", "kd_tree:retract=off,bad_splits=8",
        "kd_tree:min_volume=1e-4", "kd_tree:cost_stop=off,max_leaf=4",
        "kd_tree:look_ahead=1,max_leaf=64"}) {
    SCOPED_TRACE(spec);
    const bool is_slow = std::string(spec).find("look_ahead") != std::string::npos;
    const ScenePtr& scene = is_slow ? fewer : many;
    const auto serial = build(scene, spec);
    BuildContext context;
    context.executor = Executor::with_threads(3);
    const auto parallel = build(scene, spec, context);
    EXPECT_EQ(parallel->tree_hash(), serial->tree_hash());
    EXPECT_EQ(parallel->report().sah_cost, serial->report().sah_cost);
    EXPECT_EQ(parallel->report().binned_planes, serial->report().binned_planes);
    EXPECT_EQ(parallel->report().binning_loss, serial->report().binning_loss);
    EXPECT_EQ(parallel->report().largest_binning_loss, serial->report().largest_binning_loss);
  }
}

TEST(KdBuild, ReportsWhatBinningMayHaveLost) {
  const ScenePtr scene = soup(5000, 0.01, 26).scene();
  const BuildReport exact = build(scene, "kd_tree")->report();
  EXPECT_EQ(exact.binned_planes, 0u);
  double last = 1.0;
  for (const char* spec : {"kd_tree:split=sah_binned,bins=8", "kd_tree:split=sah_binned,bins=32",
                           "kd_tree:split=sah_binned,bins=128"}) {
    const BuildReport report = build(scene, spec)->report();
    EXPECT_GT(report.binned_planes, 20u);
    EXPECT_LT(report.binning_loss, last);
    EXPECT_GT(report.binning_loss, 0.0);
    EXPECT_LE(report.binning_loss, report.largest_binning_loss);
    EXPECT_LT(report.largest_binning_loss, 1.0);
    last = report.binning_loss;
  }
}

/// A tree with the cells and depths of its nodes.
class OpenTree {
 public:
  using Visit = std::function<void(const KdNode&, const Aabb&, int depth)>;

  OpenTree(const ScenePtr& scene, const KdTreeOptions& options) {
    const std::vector<PrimRef> refs = make_prim_refs(*scene, {});
    root_ = scene->total_bounds();
    tree_ = build_kd_tree(*scene, refs, root_, options, {}, report_);
  }
  void for_each(const Visit& visit) const { go(0, root_, 0, visit); }
  /// Cost of a subtree per line through its cell, from its own leaves; calls at(node, cost, refs).
  using CostVisit = std::function<void(const KdNode&, double, std::size_t)>;
  double cost(const SahCost& unit, const CostVisit& at) const {
    std::vector<std::uint32_t> all;
    return cost(0, root_, unit, at, all);
  }
  const BuildReport& report() const { return report_; }

 private:
  void go(std::uint32_t i, const Aabb& cell, int depth, const Visit& visit) const {
    const KdNode& node = tree_.nodes[i];
    visit(node, cell, depth);
    if (node.is_leaf()) return;
    const auto [left, right] = halves(node, cell);
    go(i + 1, left, depth + 1, visit);
    go(node.right(), right, depth + 1, visit);
  }
  double cost(std::uint32_t i, const Aabb& cell, const SahCost& unit, const CostVisit& at,
              std::vector<std::uint32_t>& all) const {
    const KdNode& node = tree_.nodes[i];
    if (node.is_leaf()) {
      const auto some = node.references(tree_.references);
      all.assign(some.begin(), some.end());
      return sah_leaf_cost(unit, some.size());
    }
    const auto [left, right] = halves(node, cell);
    std::vector<std::uint32_t> a, b;
    const double left_cost = cost(i + 1, left, unit, at, a);
    const double right_cost = cost(node.right(), right, unit, at, b);
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
    const double area = cell.half_area();
    const double sum = unit.traverse + sah_share(left.half_area(), area) * left_cost +
                       sah_share(right.half_area(), area) * right_cost;
    at(node, sum, all.size());
    return sum;
  }
  static std::pair<Aabb, Aabb> halves(const KdNode& node, const Aabb& cell) {
    Aabb left = cell, right = cell;
    left.hi[node.axis()] = right.lo[node.axis()] = node.plane();
    return {left, right};
  }

  KdArrays tree_;
  Aabb root_;
  BuildReport report_;
};

double volume(const Aabb& box) {
  const Vec3d e = box.extent();
  return e.x * e.y * e.z;
}

TEST(KdBuild, DividesNoCellBelowTheLeastVolume) {
  const ScenePtr scene = soup(2000, 0.02, 27).scene();
  const double whole = volume(scene->total_bounds());
  for (const double part : {0.1, 1e-3, 1e-5}) {
    KdTreeOptions options;
    options.min_volume = part;
    std::size_t inner = 0, small = 0;
    OpenTree(scene, options).for_each([&](const KdNode& node, const Aabb& cell, int) {
      small += volume(cell) < part * whole;
      if (node.is_leaf()) return;
      ++inner;
      EXPECT_GE(volume(cell), part * whole);
    });
    EXPECT_GT(inner, 2u);
    EXPECT_GT(small, 0u);
  }
}

TEST(KdBuild, WithoutCostsStopsByContentsAndDepthAlone) {
  KdTreeOptions options;
  options.split = KdSplit::middle;
  options.axis = KdAxis::round_robin;
  options.cost_stop = options.retract = false;
  options.max_leaf = 2;
  options.max_depth = 16;
  OpenTree(soup(500, 0.02, 28).scene(), options)
      .for_each([&](const KdNode& node, const Aabb&, int depth) {
        EXPECT_TRUE(!node.is_leaf() || node.count() <= 2 || depth == 16);
      });
}

TEST(KdBuild, RetractedTreesHaveNoInnerNodeThatDoesNotPay) {
  for (const double intersect : {0.7, 3.0}) {
    KdTreeOptions options;
    options.intersect_cost = intersect;
    options.bad_splits = 8;
    for (const ScenePtr& scene : {soup(800, 0.1, 29).scene(), mixture()}) {
      std::size_t bad[2] = {0, 0};
      double costs[2];
      for (const bool retracts : {false, true}) {
        options.retract = retracts;
        const OpenTree tree(scene, options);
        const SahCost unit{options.traverse_cost, intersect};
        const auto judge = [&](const KdNode&, double cost, std::size_t refs) {
          bad[retracts] += cost >= sah_leaf_cost(unit, refs) * (1 + 1e-9);
        };
        costs[retracts] = tree.cost(unit, judge);
        EXPECT_NEAR(costs[retracts], tree.report().sah_cost, 1e-9 * costs[retracts]);
      }
      EXPECT_GT(bad[0], 0u);
      // A cell's fragments may be fewer than what its leaves refer to was thought to be.
      EXPECT_LE(bad[1], bad[0] / 20);
      EXPECT_LT(costs[1], costs[0]);
    }
  }
}

TEST(KdBuild, CutsOffMoreEmptySpaceWhenTold) {
  KdTreeOptions options;
  options.empty_bonus = 0.0;
  const ScenePtr scene = soup(300, 0.05, 30).scene();
  std::uint64_t last = 0;
  for (const double least : {0.0, 0.3, 1e-6}) {
    options.empty_cut = least;
    const std::uint64_t empty = OpenTree(scene, options).report().empty_leaves;
    EXPECT_TRUE(least == 0.0 || empty > last) << least;
    last = empty;
  }
}

TEST(KdBuild, DividesAtAllWallsBeforeAnythingElse) {
  KdTreeOptions options;
  options.walls = true;
  int walls_met = 0;
  OpenTree(enfilade(), options).for_each([&](const KdNode& node, const Aabb& cell, int) {
    const bool spans_rooms = std::ceil(cell.hi.x) - std::floor(cell.lo.x) > 1;
    if (!spans_rooms || node.is_leaf()) return;
    EXPECT_EQ(node.axis(), 0);
    EXPECT_EQ(node.plane(), std::round(node.plane()));
    ++walls_met;
  });
  EXPECT_EQ(walls_met, 7);
}

TEST(KdBuild, LookingAheadLowersTheExpectedCost) {
  for (const ScenePtr& scene : {mixture(), soup(500, 0.1, 32).scene()})
    EXPECT_LT(build(scene, "kd_tree:look_ahead=1")->report().sah_cost,
              build(scene, "kd_tree")->report().sah_cost);
}

TEST(KdBuild, KeepsToTheMemoryLimitWithEveryBuilder) {
  const ScenePtr scene = soup(1500, 0.1, 33).scene();
  for (const char* spec : {"kd_tree:split=sah_sort", "kd_tree:split=sah_naive",
                           "kd_tree:look_ahead=1", "kd_tree:retract=on"}) {
    BuildContext context;
    context.memory_limit = 150'000;
    try {
      build(scene, spec, context);
      ADD_FAILURE() << "built beyond the limit: " << spec;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::resource);
    }
  }
}

TEST(KdBuild, RefusesBadOptionsByName) {
  const ScenePtr scene = soup(1, 0.1, 34).scene();
  for (const char* spec : {"kd_tree:empty_cut=1.1", "kd_tree:min_volume=-0.1",
                           "kd_tree:look_ahead=4", "kd_tree:walls=maybe", "kd_tree:retract=2"})
    EXPECT_THROW(build(scene, spec), Error) << spec;
}

}  // namespace
}  // namespace strahl
