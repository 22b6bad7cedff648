#include <cmath>
#include <memory>
#include <string>
#include <tests/support/mesh_maker.h>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>
#include <strahl/structures/kd_tree/kd_tree.h>

namespace strahl {
namespace {

using test::axis_vector;
using test::MeshMaker;
using test::ScenePtr;
using test::soup;
using test::walls;

/// Rays through corners, along edges, within planes, parallel to axes, from near and far away.
std::vector<Ray> nasty_rays(const Scene& scene, std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Vec3d> points;
  const Geometry& g = scene.geometries().front();
  for (std::size_t i = 0; i < g.mesh.size(); ++i)
    for (const Vec3d& v : {g.mesh[i].a, g.mesh[i].b, g.mesh[i].c}) points.push_back(v);
  const Aabb box = scene.total_bounds();
  const auto corner = [&] { return points[rng.below(static_cast<std::uint32_t>(points.size()))]; };
  const auto anywhere = [&] {
    Vec3d p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = box.lo[axis] + rng.uniform(-0.2, 1.2) * box.extent()[axis];
    return p;
  };
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Vec3d a = corner(), b = corner(), p = anywhere();
    const int axis = static_cast<int>(rng.below(3));
    const double sign = rng.below(2) == 0 ? 1.0 : -1.0;
    const Vec3d along = axis_vector(axis, sign);
    Vec3d flat = p;
    flat[axis] = a[axis];
    Vec3d in_plane = b - p;
    in_plane[axis] = 0.0;
    rays.push_back({p, a - p});                  // through a corner
    rays.push_back({a, b - a});                  // from corner to corner
    rays.push_back({a - 3.0 * (b - a), b - a});  // along an edge, from outside
    rays.push_back({a - 4.0 * along, along});    // parallel to an axis, through a corner
    rays.push_back({a, along});                  // the same from the corner
    rays.push_back({flat, in_plane});            // in a wall's plane
    rays.push_back({p, b - a});
    for (const double far : {1e6, 1e9, 1e12}) {
      const Vec3d dir = normalized(a - p);
      rays.push_back({a - far * dir, dir});
      rays.push_back({a - far * along, 1e-3 * along});
    }
    rays.push_back({p, 0.5 * a + 0.5 * b - p, 0.0, 1.0});  // ends on the surface
  }
  for (Ray& ray : rays)
    if (norm_max(ray.dir) == 0.0) ray.dir = {0, 0, 1};
  return rays;
}

struct Answers {
  std::vector<Hit> closest;
  std::vector<std::uint8_t> any;
  std::vector<std::uint32_t> counts;
  AllHits all;
};

Answers answers(const Accelerator& structure, const std::vector<Ray>& rays) {
  const RayBatch batch = make_batch(rays);
  Answers a;
  a.closest.resize(rays.size()), a.any.resize(rays.size()), a.counts.resize(rays.size());
  structure.closest_hit(batch, a.closest);
  structure.any_hit(batch, a.any);
  structure.count_hits(batch, a.counts);
  structure.all_hits(batch, a.all);
  return a;
}

bool same(const Hit& a, const Hit& b) {
  return is_same_hit(a, b) && a.is_front == b.is_front && a.reference == b.reference;
}

void expect_answers(const ScenePtr& scene, const std::string& spec, const std::vector<Ray>& rays,
                    const Answers& expected) {
  SCOPED_TRACE(spec);
  const auto tree = build(scene, spec);
  ASSERT_NO_THROW(tree->validate());
  const Answers got = answers(*tree, rays);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    wrong += !same(got.closest[i], expected.closest[i]) || got.any[i] != expected.any[i] ||
             got.counts[i] != expected.counts[i];
  EXPECT_EQ(wrong, 0u);
  ASSERT_EQ(got.all.hits.size(), expected.all.hits.size());
  for (std::size_t i = 0; i < got.all.hits.size(); ++i)
    wrong += !same(got.all.hits[i], expected.all.hits[i]);
  EXPECT_EQ(wrong, 0u);
}

const char* const kSpecs[] = {
    "kd_tree",
    "kd_tree:split=sah_binned,bins=8",
    "kd_tree:clip=off",
    "kd_tree:intersect_cost=50,empty_bonus=0.9,bad_splits=6",
    "kd_tree:max_depth=3",
    "kd_tree:split=middle",
    "kd_tree:split=median,axis=round_robin,max_leaf=2",
    "kd_tree:split=sah_binned,clip=off,max_leaf=4,bad_splits=0",
    "kd_tree:traversal=havran",
    "kd_tree:traversal=skip,node_bytes=64",
    "kd_tree:traversal=ropes",
};

void expect_all_like_brute_force(const ScenePtr& scene, std::uint64_t seed) {
  const std::vector<Ray> rays = nasty_rays(*scene, 1000, seed);
  const Answers expected = answers(*build(scene, "brute_force"), rays);
  for (const char* spec : kSpecs) expect_answers(scene, spec, rays, expected);
}

TEST(KdTree, AnswersLikeBruteForceAmongWallsOnItsPlanes) {
  expect_all_like_brute_force(walls(4, 1.0, {0, 0, 0}).scene(), 1);
}

TEST(KdTree, AnswersLikeBruteForceAmongWallsOffTheBinaryGrid) {
  expect_all_like_brute_force(walls(4, 0.1, {0.3, -0.7, 1.0 / 3.0}).scene(), 2);
}

TEST(KdTree, AnswersLikeBruteForceFarFromTheOriginWhereFloatsAreCoarse) {
  expect_all_like_brute_force(walls(4, 0.75, {1e7, -1e7, 3e6}).scene(), 3);
}

TEST(KdTree, AnswersLikeBruteForceBeyondTheRangeOfFloats) {
  expect_all_like_brute_force(walls(2, 1e60, {1e60, 0, -3e60}).scene(), 4);
  expect_all_like_brute_force(walls(2, 1e-60, {0, 1e-60, -3e-60}).scene(), 5);
}

TEST(KdTree, AnswersLikeBruteForceInSoup) {
  expect_all_like_brute_force(soup(300, 0.2, 6).scene(), 6);
  expect_all_like_brute_force(soup(400, 0.02, 7).scene(), 7);
}

TEST(KdTree, AnswersLikeBruteForceInAFlatScene) {
  MeshMaker mesh;
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j) mesh.quad({0.1 * i, 0.1 * j, 0.3}, {0.1, 0, 0}, {0, 0.1, 0});
  expect_all_like_brute_force(mesh.scene(), 8);
}

TEST(KdTree, AnswersLikeBruteForceWithSpheresAndConesUnderInstances) {
  Rng rng(9);
  SceneData data;
  data.geometries.push_back(soup(60, 0.2, 9).geometry());
  Geometry spheres, cones;
  spheres.kind = PrimitiveKind::sphere, spheres.geometry_id = 1;
  cones.kind = PrimitiveKind::cone, cones.geometry_id = 2;
  const auto point = [&] { return Vec3d{rng.uniform(), rng.uniform(), rng.uniform()}; };
  for (int i = 0; i < 60; ++i) {
    spheres.spheres.push_back({point(), rng.uniform(0.01, 0.2)});
    cones.cones.push_back({point(), rng.uniform(0.01, 0.1), point(), rng.uniform(0.01, 0.1)});
  }
  data.geometries.push_back(spheres), data.geometries.push_back(cones);
  data.instances.push_back({0, 3, {}, 0});
  data.instances.push_back(
      {0, 3,
       Affine::translation({0.7, 0.1, -0.2}) * Affine::rotation(0.36, 0.48, 0.64, 0.48) *
           Affine::scaling({1.5, 0.5, 1.0}),
       1});
  expect_all_like_brute_force(std::make_shared<const Scene>(std::move(data)), 9);
}

TEST(KdTree, HoldsNothingWhenThereIsNothingToHit) {
  MeshMaker mesh;
  for (const ScenePtr& scene :
       {mesh.scene(), (mesh.triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2}), mesh.scene())}) {
    const auto tree = build(scene, "kd_tree");
    EXPECT_NO_THROW(tree->validate());
    EXPECT_EQ(tree->report().references, 0u);
    EXPECT_EQ(tree->report().empty_leaves, 1u);
    EXPECT_FALSE(tree->closest_hit({{-1, 0.1, 0.1}, {1, 0, 0}}).is_hit());
  }
}

TEST(KdTree, StopsOnTenThousandEqualTriangles) {
  MeshMaker mesh;
  for (int i = 0; i < 10000; ++i) mesh.triangle({0, 0, 0}, {1, 0.25, 0}, {0, 1, 0.5});
  const ScenePtr scene = mesh.scene();
  for (const char* spec : {"kd_tree", "kd_tree:split=sah_binned", "kd_tree:split=middle"}) {
    const auto tree = build(scene, spec);
    EXPECT_NO_THROW(tree->validate());
    EXPECT_LE(tree->report().references, 40000u);
    EXPECT_EQ(tree->closest_hit({{0.2, 0.3, -1}, {0, 0, 1}}).id.prim, 0u);
  }
}

TEST(KdTree, IsTheSameTreeForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const ScenePtr scene = soup(30000, 0.01, 11).scene();
  for (const char* spec :
       {"kd_tree", "kd_tree:split=sah_binned", "kd_tree:clip=off", "kd_tree:split=median"}) {
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

TEST(KdTree, ReportsWhatItBuilt) {
  const ScenePtr scene = soup(2000, 0.02, 12).scene();
  const auto tree = build(scene, "kd_tree");
  const BuildReport& report = tree->report();
  EXPECT_NO_THROW(tree->validate());
  EXPECT_EQ(report.nodes, 2 * report.leaves - 1);
  EXPECT_GE(report.references, 2000u);
  EXPECT_GT(report.depth, 6u);
  EXPECT_GE(report.bytes, 8 * report.nodes);
  EXPECT_LE(report.bytes, 8 * report.nodes + 4 * report.references);
  EXPECT_LT(report.sah_cost, build(scene, "kd_tree:max_depth=4")->report().sah_cost);
}

TEST(KdTree, KeepsReferencesWithinTheGivenGrowth) {
  MeshMaker mesh;  // large overlapping triangles in one plane, which planes cut at no expected cost
  Rng rng(17);
  const auto point = [&] { return Vec3d{rng.uniform(), rng.uniform(), 0.5}; };
  for (int i = 0; i < 200; ++i) mesh.triangle(point(), point(), point());
  const ScenePtr scene = mesh.scene();
  for (const auto& [spec, most] :
       {std::pair("kd_tree:max_growth=1", 200u), std::pair("kd_tree:max_growth=4", 800u),
        std::pair("kd_tree", 6400u)}) {
    const auto tree = build(scene, spec);
    EXPECT_NO_THROW(tree->validate());
    EXPECT_LE(tree->report().references, most);
    EXPECT_GE(tree->report().references, most / 2);
  }
}

TEST(KdTree, ClippingSparesReferences) {
  const ScenePtr scene = soup(500, 0.3, 13).scene();
  const auto clipped = build(scene, "kd_tree"), boxed = build(scene, "kd_tree:clip=off");
  EXPECT_LT(clipped->report().sah_cost, boxed->report().sah_cost);
}

TEST(KdTree, KeepsToTheMemoryLimit) {
  const ScenePtr scene = soup(5000, 0.5, 14).scene();
  BuildContext context;
  context.memory_limit = 2'000'000;
  try {
    build(scene, "kd_tree:intersect_cost=1000,bad_splits=8,max_growth=10000", context);
    ADD_FAILURE() << "built beyond the limit";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::resource);
  }
}

TEST(KdTree, CanBeCancelledWhileItIsBuilt) {
  const ScenePtr scene = soup(40000, 0.01, 15).scene();
  BuildContext context;
  double last = 0.0;
  context.progress = [&](double fraction, std::string_view stage) {
    if (stage != "building") return true;
    EXPECT_GE(fraction, last);
    last = fraction;
    return fraction < 0.5;
  };
  EXPECT_THROW(build(scene, "kd_tree", context), Error);
  EXPECT_GE(last, 0.5);
  EXPECT_LT(last, 0.6);
}

TEST(KdTree, RefusesBadOptionsByName) {
  const ScenePtr scene = soup(1, 0.1, 16).scene();
  for (const char* spec : {"kd_tree:bins=1", "kd_tree:max_depth=65", "kd_tree:split=end",
                           "kd_tree:empty_bonus=1.5", "kd_tree:traverse_cost=0"})
    EXPECT_THROW(build(scene, spec), Error) << spec;
}

}  // namespace
}  // namespace strahl
