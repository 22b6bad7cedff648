#include <algorithm>
#include <cmath>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>
#include <strahl/geometry/scene.h>
#include <strahl/query/scene_visitor.h>
#include <strahl/structures/ray_classification/ray_classification.h>

namespace strahl {

/// May spoil what validate() has to notice.
class RayClassificationBreaker {
 public:
  static std::vector<CandidateGroup>& groups(RayClassification& r) { return r.candidates_.groups_; }
  static std::vector<StoredBall>& balls(RayClassification& r) { return r.candidates_.balls_; }
  static std::vector<std::uint32_t>& order(RayClassification& r) { return r.candidates_.order_[0]; }
  static std::vector<std::uint32_t>& references(RayClassification& r) {
    return r.candidates_.references_;
  }
  static CellCache& cells(RayClassification& r) { return *r.cells_; }
};

namespace {

using Breaker = RayClassificationBreaker;
using ScenePtr = std::shared_ptr<const Scene>;

Vec3d any(Rng& rng, double reach = 1.0) {
  const double x = rng.uniform(-reach, reach), y = rng.uniform(-reach, reach);
  return {x, y, rng.uniform(-reach, reach)};
}

Geometry soup(int count, double size, double scale, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (int i = 0; i < 3 * count; ++i) {
    const Vec3d around = i % 3 == 0 ? Vec3d{} : vertices[static_cast<std::size_t>(i - i % 3)];
    vertices.push_back(around + scale * any(rng, i % 3 == 0 ? 1.0 : size));
    indices.push_back(static_cast<std::uint32_t>(i));
  }
  Geometry geometry;
  geometry.mesh = make_mesh(std::move(vertices), std::move(indices));
  return geometry;
}

ScenePtr scene_of(std::vector<Geometry> geometries, std::vector<Affine> maps = {}) {
  SceneData data;
  data.geometries = std::move(geometries);
  const auto count = static_cast<std::uint32_t>(data.geometries.size());
  for (const Affine& map : maps)
    data.instances.push_back({0, count, map, static_cast<std::uint32_t>(data.instances.size())});
  return std::make_shared<const Scene>(std::move(data));
}

/// Triangles, spheres, cones of all slopes, cylinders.
std::vector<Geometry> mixture(std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Geometry> all{soup(150, 0.3, 1.0, seed)};
  Geometry spheres, cones;
  spheres.kind = PrimitiveKind::sphere, cones.kind = PrimitiveKind::cone;
  spheres.geometry_id = 1, cones.geometry_id = 2;
  for (int i = 0; i < 60; ++i) {
    const double radius = std::ldexp(1.0, -1 - i % 9);
    spheres.spheres.push_back({any(rng), radius});
    const Vec3d base = any(rng);
    cones.cones.push_back({base, radius, base + any(rng, i % 4 == 0 ? 0.01 : 0.6),
                           i % 3 == 0   ? 0.0
                           : i % 3 == 1 ? radius
                                        : radius * rng.uniform()});
  }
  all.push_back(std::move(spheres)), all.push_back(std::move(cones));
  return all;
}

/// From inside, outside and far away, along axes and diagonals of the direction cube.
std::vector<Ray> rays_into(const Scene& scene, int count, std::uint64_t seed) {
  Rng rng(seed);
  const Aabb& box = scene.total_bounds();
  const double size = norm_max(box.extent());
  const auto inside = [&] {
    Vec3d p = any(rng);
    for (int a = 0; a < 3; ++a) p[a] = box.center()[a] + 0.5 * p[a] * box.extent()[a];
    return p;
  };
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    Ray ray{inside(), any(rng)};
    if (i % 4 == 1) ray.dir[static_cast<int>(rng.below(3))] = 0.0;
    if (i % 8 == 2) ray.dir = {1, rng.below(2) ? 1.0 : -1.0, rng.uniform(-1, 1)};
    if (i % 8 == 3) ray.dir = {0, 0, 0}, ray.dir[static_cast<int>(rng.below(3))] = -1;
    if (i % 3 == 0) ray.org = ray.org - std::ldexp(size, static_cast<int>(rng.below(30))) * ray.dir;
    if (i % 5 == 0) ray.dir = std::ldexp(1.0, static_cast<int>(rng.below(400)) - 200) * ray.dir;
    if (i % 7 == 0) ray.t_min = rng.uniform() * size / norm_max(ray.dir);
    if (i % 11 == 0) ray.t_max = ray.t_min + rng.uniform() * size / norm_max(ray.dir);
    rays.push_back(ray);
  }
  return rays;
}

struct AllOf : CollectHits {
  using CollectHits::CollectHits;
};

/// Every hit of the ray by testing every primitive.
std::vector<Hit> brute_hits(const Scene& scene, const Ray& ray, bool culls) {
  std::vector<Hit> hits;
  HitFilter filter;
  filter.cull_back = culls;
  AllOf query(ray, filter, hits);
  SceneVisitor prims(scene);
  NoCounters counters;
  prims.begin_ray();
  const PreparedRay prepared(ray, scene.world_frame());
  for (std::uint32_t i = 0; i < scene.size(); ++i)
    if (!scene.bounds(i).is_empty()) prims.visit(i, prepared, query, counters);
  return hits;
}

void expect_sound(const ScenePtr& scene, const RayClassificationOptions& options, int count) {
  const RayClassification structure(*scene, options, {});
  std::size_t hits = 0;
  for (int round = 0; round < 2; ++round)  // the second finds more cells
    for (const Ray& ray : rays_into(*scene, count, 5)) {
      if (!is_valid(ray)) continue;
      const PreparedRay prepared(ray, scene->world_frame());
      for (const bool culls : {false, true}) {
        const auto listed = structure.candidates_of(prepared, culls);
        for (const Hit& hit : brute_hits(*scene, ray, culls)) {
          ASSERT_TRUE(std::binary_search(listed.begin(), listed.end(), hit.reference));
          ++hits;
        }
      }
    }
  EXPECT_GT(hits, static_cast<std::size_t>(count) / 2);
  ASSERT_NO_THROW(structure.validate(*scene));
}

RayClassificationOptions fine() {
  RayClassificationOptions options;
  options.max_candidates = 1, options.patience = 1, options.group_size = 1;
  options.bytes_per_primitive = 1 << 20;
  return options;
}

TEST(RayClassification, WhatARayHitsIsInItsList) {
  RayClassificationOptions groups = fine();
  groups.group_size = 5;
  for (const auto& options : {fine(), groups}) {
    expect_sound(scene_of(mixture(1)), options, 250);
    expect_sound(scene_of({soup(200, 0.3, 1e-60, 2)}), options, 150);
    expect_sound(scene_of({soup(200, 0.3, 1e60, 3)}), options, 150);
  }
}

TEST(RayClassification, WhatARayHitsThroughAnInstanceIsInItsList) {
  const Affine turned = Affine::rotation(0.48, 0.6, 0.0, 0.64);
  const std::vector<Affine> maps{{},
                                 Affine::translation({3, 1, 0}) * Affine::scaling({-1, 2, 0.5}),
                                 Affine::translation({-2, 0, 1}) * turned};
  expect_sound(scene_of(mixture(4), maps), fine(), 120);
  const std::vector<Affine> far{Affine::translation({1e5, -1e5, 1e5}) * turned};
  expect_sound(scene_of(mixture(5), far), fine(), 120);
}

TEST(RayClassification, CullingShortensListsOfClosedMeshes) {
  // Each triangle also from behind, so half of all are backs for every ray.
  Geometry both = soup(300, 0.2, 1.0, 6);
  std::vector<Vec3d> v;
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < both.mesh.size(); ++i) {
    const TriangleVertices t = both.mesh[i];
    for (const Vec3d& p : {t.a, t.b, t.c, t.c, t.b, t.a})
      indices.push_back(static_cast<std::uint32_t>(v.size())), v.push_back(p);
  }
  both.mesh = make_mesh(std::move(v), std::move(indices));
  const ScenePtr scene = scene_of({both});
  const RayClassification structure(*scene, fine(), {});
  std::size_t plain = 0, culled = 0;
  for (const Ray& ray : rays_into(*scene, 400, 7)) {
    const PreparedRay prepared(ray, scene->world_frame());
    const std::size_t all = structure.candidates_of(prepared, false).size();
    if (all == scene->size()) continue;  // from too far away for cells
    plain += all;
    culled += structure.candidates_of(prepared, true).size();
  }
  EXPECT_LT(culled, plain * 3 / 4);
  EXPECT_GE(culled, plain / 2);
}

std::vector<Hit> hits_of(const Accelerator& a, const std::vector<Ray>& rays, bool culls,
                         const BatchContext& context = {}) {
  std::vector<Hit> hits(rays.size());
  RayBatch batch = make_batch(rays);
  batch.cull_back = culls;
  a.closest_hit(batch, hits, context);
  return hits;
}

void expect_equal(const std::vector<Hit>& got, const std::vector<Hit>& expected) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(got[i].t, expected[i].t) << i;
    ASSERT_EQ(got[i].reference, expected[i].reference) << i;
  }
}

TEST(RayClassification, CellsFollowFromTheRaysNotFromThreads) {
  const ScenePtr scene = scene_of(mixture(8));
  const std::vector<Ray> rays = rays_into(*scene, 3000, 9);
  const char* spec = "ray_classification:max_candidates=4,patience=1,bytes_per_primitive=1000000";
  const auto serial = build(scene, spec), parallel = build(scene, spec);
  BatchContext four;
  four.context.executor = Executor::with_threads(4);
  for (int round = 0; round < 3; ++round) {
    const auto expected = hits_of(*serial, rays, false);
    expect_equal(hits_of(*parallel, rays, false, four), expected);
  }
  EXPECT_GT(serial->report().nodes, 200u);
  EXPECT_EQ(serial->report().nodes, parallel->report().nodes);
  EXPECT_EQ(serial->report().references, parallel->report().references);
  EXPECT_EQ(serial->tree_hash(), parallel->tree_hash());
  EXPECT_EQ(serial->tree_hash(), build(scene, spec)->tree_hash()) << "rays must not change it";
}

TEST(RayClassification, ThreadsThatEvictAnswerLikeBruteForce) {
  const ScenePtr scene = scene_of(mixture(10));
  const std::vector<Ray> rays = rays_into(*scene, 1500, 11);
  const auto brute = build(scene, "brute_force");
  const std::vector<Hit> expected[2] = {hits_of(*brute, rays, false), hits_of(*brute, rays, true)};
  RayClassificationOptions options;
  options.max_candidates = 1, options.patience = 1, options.group_size = 2;
  options.bytes_per_primitive = 400;
  const RayClassification structure(*scene, options, {});
  const auto trace_all = [&](bool culls) {
    SceneVisitor prims(*scene);
    NoCounters counters;
    HitFilter filter;
    filter.cull_back = culls;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!is_valid(rays[i])) continue;
      prims.begin_ray();
      ClosestHit query(rays[i], filter);
      structure.trace(prims, PreparedRay(rays[i], scene->world_frame()), query, counters);
      ASSERT_EQ(query.best.t, expected[culls][i].t) << i;
      ASSERT_EQ(query.best.reference, expected[culls][i].reference) << i;
      ASSERT_LE(structure.report().bytes, 400u * scene->size()) << i;
    }
  };
  std::thread other([&] { trace_all(true); });
  trace_all(false);
  other.join();
  EXPECT_GT(structure.figures().evicted, 100u);
  ASSERT_NO_THROW(structure.validate(*scene));
}

TEST(RayClassification, TheMemoryLimitOfTheBuildHoldsWhileTracing) {
  const ScenePtr scene = scene_of({soup(500, 0.2, 1.0, 12)});
  BuildContext context;
  context.memory_limit = 100000;
  RayClassificationOptions options = fine();
  const RayClassification structure(*scene, options, context);
  for (const Ray& ray : rays_into(*scene, 500, 13)) {
    structure.candidates_of(PreparedRay(ray, scene->world_frame()), false);
    ASSERT_LE(structure.report().bytes, context.memory_limit);
  }
  EXPECT_GT(structure.figures().evicted, 0u);
}

TEST(RayClassification, ReportsGrowWithTheCells) {
  const ScenePtr scene = scene_of({soup(2000, 0.1, 1.0, 14)});
  const auto built = build(scene, "ray_classification:patience=1,max_candidates=8");
  const BuildReport before = built->report();
  EXPECT_EQ(before.nodes, 12u);
  EXPECT_EQ(before.depth, 0u);
  hits_of(*built, rays_into(*scene, 500, 15), false);
  const BuildReport after = built->report();
  EXPECT_GT(after.nodes, 100u);
  EXPECT_GT(after.depth, 1u);
  EXPECT_GT(after.bytes, before.bytes);
  EXPECT_EQ(after.seconds, before.seconds);
}

TEST(RayClassification, ListsEndWhereNothingNearerCanFollow) {
  const ScenePtr scene = scene_of({soup(3000, 0.3, 1.0, 16)});
  const auto built = build(scene, "ray_classification:max_candidates=1000000");
  const std::vector<Ray> rays = rays_into(*scene, 300, 17);
  BatchContext counting;
  counting.count_work = true;
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint32_t> counts(rays.size());
  const auto closest = built->closest_hit(make_batch(rays), hits, counting).counters;
  const auto all = built->count_hits(make_batch(rays), counts, counting).counters;
  EXPECT_LT(closest.bounding_volumes, all.bounding_volumes * 3 / 4);
}

TEST(RayClassification, ValidateNoticesFaults) {
  const ScenePtr scene = scene_of({soup(400, 0.2, 1.0, 18)});
  RayClassificationOptions options = fine();
  options.group_size = 4;
  RayClassification structure(*scene, options, {});
  for (const Ray& ray : rays_into(*scene, 100, 19))
    structure.candidates_of(PreparedRay(ray, scene->world_frame()), false);
  ASSERT_NO_THROW(structure.validate(*scene));
  const auto refuses = [&](auto& value, auto wrong) {
    std::swap(value, wrong);
    EXPECT_THROW(structure.validate(*scene), std::logic_error);
    std::swap(value, wrong);
  };
  CandidateGroup& group = Breaker::groups(structure)[3];
  refuses(group.count, group.count + 1);
  refuses(group.box.hi.y, group.box.hi.y - 1e-9);
  refuses(Breaker::references(structure)[7], Breaker::references(structure)[8]);
  refuses(Breaker::order(structure)[0], Breaker::order(structure)[1]);
  StoredBall& ball = Breaker::balls(structure)[0];
  refuses(ball.x, ball.x + 0.001f);
  CellCache& cells = Breaker::cells(structure);
  const Epochs::Reader reading = cells.reader();
  for (unsigned i = 0; i < 32; ++i) {
    const CellCache::Cell* cell = cells.root(0).child(i);
    if (cell == nullptr || cell->list().empty()) continue;
    refuses(const_cast<std::uint32_t&>(cell->list()[0]), cell->list()[0] + 1);
    break;
  }
  ASSERT_NO_THROW(structure.validate(*scene));
}

TEST(RayClassification, OfNothingHitsNothing) {
  const ScenePtr scene = scene_of({});
  const RayClassification structure(*scene, {}, {});
  ASSERT_NO_THROW(structure.validate(*scene));
  EXPECT_EQ(structure.report().nodes, 0u);
  EXPECT_TRUE(structure.candidates_of(PreparedRay({{0, 0, 0}, {1, 0, 0}}, {}), false).empty());
}

}  // namespace
}  // namespace strahl
