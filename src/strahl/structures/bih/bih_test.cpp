#include <functional>
#include <tests/support/doctored.h>
#include <tests/support/mesh_maker.h>

#include <gtest/gtest.h>

#include <strahl/catalog/catalog.h>
#include <strahl/structures/bih/bih.h>
#include <strahl/structures/bih/bih_layout.h>
#include <strahl/structures/bih/bih_validate.h>

namespace strahl {
namespace {

using test::Doctored;
using test::MeshMaker;
using test::ScenePtr;
using test::soup;

const char* const kSplits[] = {"bih", "bih:split=sah_sweep", "bih:split=global",
                               "bih:planes=free,split=global"};

/// Small triangles at these places of the x axis.
ScenePtr on_x_axis(const std::vector<double>& places) {
  MeshMaker mesh;
  for (const double x : places) mesh.triangle({x, 0, 0}, {x + 0.01, 0, 1}, {x, 1, 0});
  return mesh.scene();
}

/// A box of twelve triangles around many small ones.
MeshMaker room_of_dust(std::size_t count) {
  MeshMaker mesh = soup(count, 0.01, 3);
  const Vec3d lo{-4, -4, -4};
  const Vec3d x{9, 0, 0}, y{0, 9, 0}, z{0, 0, 9};
  mesh.quad(lo, x, y), mesh.quad(lo, y, z), mesh.quad(lo, z, x);
  mesh.quad(lo + z, x, y), mesh.quad(lo + x, y, z), mesh.quad(lo + y, z, x);
  return mesh;
}

TEST(Bih, OfNothingHasNoNodesAndHitsNothing) {
  MeshMaker mesh;
  mesh.triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
  const auto tree = build(mesh.scene(), "bih");
  EXPECT_NO_THROW(tree->validate());
  EXPECT_EQ(tree->report().nodes, 0u);
  EXPECT_FALSE(tree->closest_hit({{-1, 0.1, 0.1}, {1, 0, 0}}).is_hit());
}

TEST(Bih, RefersToEveryPrimitiveOnceInTwiceAsManyNodesAsLeavesLessOne) {
  const ScenePtr scene = soup(2000, 0.1, 1).scene();
  for (const char* spec : {"bih:trim=0,leaf_size=1", "bih:trim=0,leaf_size=1,split=global"}) {
    const auto tree = build(scene, spec);
    EXPECT_NO_THROW(tree->validate());
    EXPECT_EQ(tree->report().references, 2000u);
    EXPECT_EQ(tree->report().leaves, 2000u);
    EXPECT_EQ(tree->report().nodes, 3999u);
    EXPECT_EQ(tree->report().bytes, 12 * 3999u + 4 * 2000u);
  }
}

TEST(Bih, CostsAreThoseOfTheBoxesThatThePlanesLeave) {
  // Unit cubes of two triangles each, three apart: the root's half area is 9, a child's 3.
  MeshMaker mesh;
  for (const double x : {0.0, 3.0}) {
    mesh.triangle({x, 0, 0}, {x + 1, 1, 0}, {x, 1, 1});
    mesh.triangle({x, 0, 0}, {x + 1, 1, 1}, {x, 0, 1});
  }
  const auto tree = build(mesh.scene(), "bih:leaf_size=2,traverse_cost=4,intersect_cost=2");
  EXPECT_EQ(tree->report().nodes, 3u);
  EXPECT_DOUBLE_EQ(tree->report().sah_cost, (4 + 2 * (3.0 / 9.0) * 2 * 2) / 4);
}

TEST(Bih, GlobalSplitHalvesTheBoxOfTheSceneNotOfTheNode) {
  // Halves [0, 8): 0 1 2 | 7, then [0, 4): 0 1 | 2, then [0, 2): 0 | 1. By rank all would be at 2.
  const ScenePtr scene = on_x_axis({0, 1, 2, 7.99});
  EXPECT_EQ(build(scene, "bih:split=global,leaf_size=1,trim=0")->report().depth, 3u);
}

TEST(Bih, GlobalSplitPassesOverEmptyHalvesWithoutANode) {
  // 0 | rest; [254, 508) becomes [500, 508): 500.1 500.2 500.3 | 507.9; then [500, 500.5) is
  // halved.
  const ScenePtr high = on_x_axis({0, 500.1, 500.2, 500.3, 507.99});
  const auto above = build(high, "bih:split=global,leaf_size=1,trim=0");
  EXPECT_EQ(above->report().nodes, 9u);
  EXPECT_EQ(above->report().depth, 4u);
  const auto below =
      build(on_x_axis({0, 0.001, 0.002, 0.02, 1000}), "bih:split=global,leaf_size=1,trim=0");
  EXPECT_EQ(below->report().nodes, 9u);
  EXPECT_EQ(below->report().depth, 4u);
}

TEST(Bih, TrimsNodesThatFillTooLittle) {
  const ScenePtr scene = room_of_dust(500).scene();
  const auto loose = build(scene, "bih:trim=0"), tight = build(scene, "bih:trim=0.75");
  const auto all = build(scene, "bih:trim=1");
  EXPECT_EQ(loose->report().nodes, 2 * loose->report().leaves - 1);
  EXPECT_GT(tight->report().nodes, loose->report().nodes);
  EXPECT_GT(all->report().nodes, tight->report().nodes);
  EXPECT_LT(tight->report().sah_cost, 0.8 * loose->report().sah_cost);
  for (const auto& tree : {&loose, &tight, &all}) EXPECT_NO_THROW((*tree)->validate());
}

TEST(Bih, PlanesOfFreeOrientationLeaveSmallerBoxes) {
  const ScenePtr scene = soup(3000, 0.1, 4).scene();
  const auto parallel = build(scene, "bih:trim=0"), free = build(scene, "bih:trim=0,planes=free");
  EXPECT_EQ(free->report().nodes, parallel->report().nodes);
  EXPECT_LT(free->report().sah_cost, parallel->report().sah_cost);
  EXPECT_NE(free->tree_hash(), parallel->tree_hash());
}

TEST(Bih, StopsOnTenThousandEqualTriangles) {
  MeshMaker mesh;
  for (int i = 0; i < 10000; ++i) mesh.triangle({0, 0, 0}, {1, 0.25, 0}, {0, 1, 0.5});
  const ScenePtr scene = mesh.scene();
  for (const char* spec : kSplits) {
    const auto tree = build(scene, spec);
    EXPECT_NO_THROW(tree->validate()) << spec;
    EXPECT_EQ(tree->report().references, 10000u);
    EXPECT_EQ(tree->closest_hit({{0.2, 0.3, -1}, {0, 0, 1}}).id.prim, 0u);
  }
}

TEST(Bih, StaysWithinItsDepthOnGeometricSeries) {
  std::vector<double> places{0.0};
  for (double x = 1.0; places.size() < 200; x *= 0.5) places.push_back(x);
  MeshMaker mesh;
  for (const double x : places) mesh.triangle({x, 0, 0}, {x * 1.01, 0, x}, {x, x, 1e-70});
  for (const char* spec : kSplits) {
    const auto tree = build(mesh.scene(), spec);
    EXPECT_NO_THROW(tree->validate()) << spec;
    EXPECT_LE(tree->report().depth, 4u * Bih::kMaxDepth);
    EXPECT_TRUE(tree->closest_hit({{0.501, 1e-3, -1}, {0, 0, 1}}).is_hit());
  }
}

TEST(Bih, VisitsTheFarChildOfAnOverlapOnlyAsFarAsTheHit) {
  const ScenePtr scene = soup(2000, 0.1, 5).scene();
  std::vector<Ray> rays;
  Rng rng(6);
  for (int i = 0; i < 300; ++i)
    rays.push_back({{rng.uniform(), rng.uniform(), -1}, {rng.uniform(-0.3, 0.3), 0.1, 1}});
  BatchContext counting;
  counting.count_work = true;
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint32_t> counts(rays.size());
  for (const char* spec : kSplits) {
    const auto tree = build(scene, spec);
    const auto first = tree->closest_hit(make_batch(rays), hits, counting).counters;
    const auto all = tree->count_hits(make_batch(rays), counts, counting).counters;
    EXPECT_LT(3 * first.traversal_steps, 2 * all.traversal_steps) << spec;
    EXPECT_LT(2 * first.primitives, all.primitives) << spec;
  }
}

TEST(Bih, ValidateNoticesOtherPrimitives) {
  const ScenePtr scene = soup(100, 0.5, 7).scene();
  for (const BihPlanes planes : {BihPlanes::parallel, BihPlanes::free}) {
    BihOptions options;
    options.planes = planes;
    const Bih tree(*scene, options, {});
    ASSERT_NO_THROW(tree.validate(*scene));
    const auto larger = [](std::uint32_t i, Aabb box) {
      if (i == 7) box.hi.x += 1.0;
      return box;
    };
    const auto fewer = [](std::uint32_t i, Aabb box) { return i == 7 ? Aabb{} : box; };
    EXPECT_THROW(tree.validate(Doctored(*scene, larger)), std::logic_error);
    EXPECT_THROW(tree.validate(Doctored(*scene, fewer)), std::logic_error);
    const Bih without(Doctored(*scene, fewer), options, {});
    EXPECT_THROW(without.validate(*scene), std::logic_error);
  }
}

/// Two triangles, two leaves, by hand.
struct SmallBih {
  ScenePtr scene = on_x_axis({0, 1});
  Aabb root = scene->total_bounds();
  BihArrays tree{{BihNode::inner({0, false, 0.01}, {0, true, 1.0}, 1), BihNode::leaf(0, 1),
                  BihNode::leaf(1, 1)},
                 {0, 1}};
  BuildReport report;

  SmallBih() { report.nodes = 3, report.leaves = 2, report.references = 2, report.depth = 1; }
  void expect_broken(const std::function<void(SmallBih&)>& damage) const {
    SmallBih damaged = *this;
    ASSERT_NO_THROW(validate_bih(damaged.tree, root, damaged.report, *scene));
    damage(damaged);
    EXPECT_THROW(validate_bih(damaged.tree, root, damaged.report, *scene), std::logic_error);
  }
};

TEST(Bih, ValidateNoticesDamagedNodes) {
  const SmallBih small;
  small.expect_broken([](SmallBih& b) {
    b.tree.nodes[0] = BihNode::inner({0, false, 0.009}, {0, true, 1.0}, 1);  // cuts the left one
  });
  small.expect_broken([](SmallBih& b) {
    b.tree.nodes[0] = BihNode::inner({0, true, 0.01}, {0, true, 1.0}, 1);  // the wrong side
  });
  small.expect_broken([](SmallBih& b) {
    b.tree.nodes[0] = BihNode::inner({0, false, 0.01}, {0, true, 1.0}, 0);  // its own child
  });
  small.expect_broken([](SmallBih& b) {
    b.tree.nodes[0] = BihNode::inner({0, false, 0.01}, {0, true, 1.0}, 2);  // beyond the last
  });
  small.expect_broken([](SmallBih& b) { b.tree.nodes[0] = BihNode::trimmed(0, 0, 1.01, 1); });
  small.expect_broken([](SmallBih& b) { b.tree.nodes[2] = BihNode::leaf(0, 1); });
  small.expect_broken([](SmallBih& b) { b.tree.nodes[2] = BihNode::leaf(1, 0); });
  small.expect_broken([](SmallBih& b) { b.tree.nodes[2] = BihNode::leaf(1, 2); });
  small.expect_broken([](SmallBih& b) { b.tree.references = {1, 0}; });
  small.expect_broken([](SmallBih& b) { b.tree.references.push_back(0); });
  small.expect_broken([](SmallBih& b) { b.tree.nodes.push_back(BihNode::leaf(1, 1)); });
  small.expect_broken([](SmallBih& b) { ++b.report.depth; });
}

TEST(Bih, PlanesAreRoundedAwayFromWhatTheyBound) {
  const double third = 1.0 / 3.0;
  const BihNode node = BihNode::inner({1, false, third}, {2, true, third}, 5);
  EXPECT_GT(node.plane(0), third);
  EXPECT_LT(node.plane(1), third);
  EXPECT_EQ(node.side(0).axis, 1);
  EXPECT_FALSE(node.side(0).is_above);
  EXPECT_EQ(node.side(1).axis, 2);
  EXPECT_TRUE(node.side(1).is_above);
  EXPECT_EQ(node.child(), 5u);
  EXPECT_LT(BihNode::trimmed(2, third, third, 1).plane(0), third);
  EXPECT_GT(BihNode::trimmed(2, third, third, 1).plane(1), third);
}

TEST(Bih, IsTheSameTreeForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const ScenePtr scene = soup(30000, 0.01, 8).scene();
  for (const char* spec : kSplits) {
    const auto serial = build(scene, spec);
    for (const int threads : {2, 4}) {
      BuildContext context;
      context.executor = Executor::with_threads(threads);
      const auto parallel = build(scene, spec, context);
      EXPECT_EQ(parallel->tree_hash(), serial->tree_hash());
      EXPECT_EQ(parallel->report().sah_cost, serial->report().sah_cost);
      EXPECT_EQ(parallel->report().bytes, serial->report().bytes);
    }
  }
}

TEST(Bih, KeepsToTheMemoryLimit) {
  const ScenePtr scene = soup(5000, 0.1, 9).scene();
  BuildContext context;
  for (const std::uint64_t limit : {300'000u, 900'000u}) {  // for references, for the tree
    context.memory_limit = limit;
    try {
      build(scene, "bih", context);
      ADD_FAILURE() << "built beyond " << limit;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::resource);
    }
  }
}

TEST(Bih, CanBeCancelledWhileItIsBuilt) {
  const ScenePtr scene = soup(40000, 0.01, 10).scene();
  for (const char* spec : kSplits) {
    BuildContext context;
    double last = 0.0;
    context.progress = [&](double fraction, std::string_view stage) {
      if (stage == "building") last = fraction;
      return stage != "building" || fraction < 0.5;
    };
    EXPECT_THROW(build(scene, spec, context), Error);
    EXPECT_GE(last, 0.5);
    EXPECT_LT(last, 0.6);
  }
}

TEST(Bih, RefusesBadOptionsByName) {
  const ScenePtr scene = soup(1, 0.1, 11).scene();
  for (const char* spec : {"bih:bins=1", "bih:trim=1.5", "bih:split=middle", "bih:planes=oblique",
                           "bih:leaf_size=0", "bih:traverse_cost=0"})
    EXPECT_THROW(build(scene, spec), Error) << spec;
}

}  // namespace
}  // namespace strahl
