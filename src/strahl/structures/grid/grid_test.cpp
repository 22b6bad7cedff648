#include <cmath>
#include <memory>
#include <tests/support/doctored.h>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>
#include <strahl/geometry/triangle.h>
#include <strahl/structures/grid/grid.h>

namespace strahl {
namespace {

using test::Doctored;
using ScenePtr = std::shared_ptr<const Scene>;

ScenePtr scene_of(std::vector<Vec3d> vertices, std::vector<Instance> instances = {}) {
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < vertices.size(); ++i)
    indices.push_back(static_cast<std::uint32_t>(i));
  Geometry geometry;
  geometry.mesh = make_mesh(std::move(vertices), std::move(indices));
  SceneData data;
  data.geometries.push_back(std::move(geometry));
  data.instances = std::move(instances);
  return std::make_shared<const Scene>(std::move(data));
}

Vec3d random_point(Rng& rng, double reach) {
  const double x = rng.uniform(-reach, reach), y = rng.uniform(-reach, reach);
  return {x, y, rng.uniform(-reach, reach)};
}

std::vector<Vec3d> soup(int count, double size, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Vec3d> vertices;
  for (int i = 0; i < count; ++i) {
    const Vec3d center = random_point(rng, 1.0);
    for (int k = 0; k < 3; ++k) vertices.push_back(center + random_point(rng, size));
  }
  return vertices;
}

/// Walls in all planes of the 4 * 4 * 4 cells of a cube, one pair of triangles per cell side.
std::vector<Vec3d> walls_in_cell_planes() {
  const UniformCells cells({{-1, -1, -1}, {2, 2, 2}}, {4, 4, 4});
  std::vector<Vec3d> vertices;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i <= 4; ++i)
      for (int j = 0; j < 4; ++j)
        for (int k = 0; k < 4; ++k) {
          const auto corner = [&](int dj, int dk) {
            Vec3d p;
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            p[axis] = cells.plane(axis, i);
            p[u] = cells.plane(u, j + dj), p[v] = cells.plane(v, k + dk);
            return min(p, Vec3d::all(2));
          };
          for (const Vec3d& p : {corner(0, 0), corner(1, 0), corner(1, 1)}) vertices.push_back(p);
          for (const Vec3d& p : {corner(0, 0), corner(1, 1), corner(0, 1)}) vertices.push_back(p);
        }
  return vertices;
}

void expect_same_answers(const ScenePtr& scene, const std::vector<Ray>& rays,
                         const std::string& spec) {
  const auto grid = build(scene, spec), oracle = build(scene, "brute_force");
  ASSERT_NO_THROW(grid->validate());
  AllHits got, expected;
  grid->all_hits(make_batch(rays), got);
  oracle->all_hits(make_batch(rays), expected);
  ASSERT_EQ(got.splits, expected.splits) << spec;
  ASSERT_GT(expected.hits.size(), rays.size() / 8);
  for (std::size_t i = 0; i < got.hits.size(); ++i)
    ASSERT_TRUE(is_same_hit(got.hits[i], expected.hits[i])) << spec;
  std::vector<Hit> first(rays.size()), nearest(rays.size());
  grid->closest_hit(make_batch(rays), first);
  oracle->closest_hit(make_batch(rays), nearest);
  for (std::size_t i = 0; i < rays.size(); ++i)
    ASSERT_TRUE(is_same_hit(first[i], nearest[i])) << spec << " ray " << i;
}

TEST(Grid, FindsHitsInPlanesAndOnEdgesBetweenCells) {
  const std::vector<Vec3d> vertices = walls_in_cell_planes();
  const ScenePtr scene = scene_of(vertices);
  Rng rng(1);
  std::vector<Ray> rays;
  const auto corner = [&] {
    return vertices[rng.below(static_cast<std::uint32_t>(vertices.size()))];
  };
  for (int i = 0; i < 400; ++i) {
    const Vec3d a = corner(), b = corner();
    if (a == b) continue;
    Vec3d along;
    along[static_cast<int>(rng.below(3))] = rng.below(2) ? 1.0 : -1.0;
    rays.push_back({a - 2.0 * (b - a), b - a});
    rays.push_back({a, b - a});
    rays.push_back({a, b - a, 0.0, 1.0});
    rays.push_back({b - 5.0 * along, along});
    rays.push_back({0.5 * (a + b) - 5.0 * along, along});
    rays.push_back({random_point(rng, 3.0), a - random_point(rng, 3.0)});
  }
  for (const char* options : {"", ",exact=false", ",mailbox=false"})
    expect_same_answers(scene, rays, std::string("grid:resolution=fixed,nx=4,ny=4,nz=4") + options);
}

/// Rays that begin far away and aim at corners; dir is such that t is about 1 or about `distance`.
std::vector<Ray> far_rays(const Scene& scene, double distance, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Ray> rays;
  for (int i = 0; i < 100; ++i) {
    const std::uint32_t reference = rng.below(scene.size());
    const Aabb box = scene.bounds(reference);
    const Vec3d dir = random_point(rng, 1.0), org = box.center() - distance * dir;
    rays.push_back({org, dir});
    rays.push_back({org, box.center() - org});
  }
  return rays;
}

TEST(Grid, FindsHitsFromAnyDistance) {
  for (const double distance : {1e3, 1e9, 1e12, 1e13, 1e14}) {
    const ScenePtr scene = scene_of(soup(200, 1.0, 2));
    expect_same_answers(scene, far_rays(*scene, distance, 3), "grid:density=20");
  }
}

TEST(Grid, SurvivesOriginsSoFarThatEveryCellMayBeMet) {
  const std::vector<Vec3d> vertices{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0},
                                    {-1, -1, 1}, {1, -1, 1}, {0, 1, 2}};
  const ScenePtr scene = scene_of(vertices);
  std::vector<Ray> rays;
  for (const double z : {-1e30, 1e30, -1e60, 1e18})
    for (const double x : {0.0, 0.25, -0.5})
      rays.push_back({{x, -0.5, z}, {0, 0, z < 0 ? 1.0 : -1.0}});
  expect_same_answers(scene, rays, "grid:resolution=fixed,nx=9,ny=9,nz=9");
}

TEST(Grid, FindsHitsOfInstancesFromAnyDistance) {
  Instance turned;
  turned.first_geometry = 0, turned.geometry_count = 1;
  turned.to_world = Affine::translation({1e3, -2e3, 5e2}) * Affine::scaling({3.0, 0.01, 1.0}) *
                    Affine::rotation(0.1, 0.2, 0.3, std::sqrt(1 - 0.14));
  const ScenePtr scene = scene_of(soup(150, 1.0, 4), {turned});
  for (const double distance : {1.0, 1e6, 1e10})
    expect_same_answers(scene, far_rays(*scene, distance, 5), "grid:density=20");
}

TEST(Grid, AFartherHitFoundFirstDoesNotHideANearerOne) {
  // The long triangle is listed in the first cells but hit in the last one, behind the small one.
  const ScenePtr scene =
      scene_of({{0, -1, 0.1}, {10, -1, 9}, {10, 3, 9}, {6, -1, 0}, {6, -1, 8}, {6, 3, 4}});
  const auto grid = build(scene, "grid:resolution=fixed,nx=10,ny=2,nz=2,exact=false");
  const std::vector<Ray> rays{{{-1, 0, 4.5}, {1, 0, 0.2}}};
  std::vector<Hit> hits(1), expected(1);
  grid->closest_hit(make_batch(rays), hits);
  build(scene, "brute_force")->closest_hit(make_batch(rays), expected);
  ASSERT_TRUE(expected[0].is_hit());
  EXPECT_TRUE(is_same_hit(hits[0], expected[0]));
}

/// A ray and a triangle beyond the plane x = p that it grazes, hit by its rounded t before p.
struct GrazedBeyondPlane {
  Ray ray;
  TriangleVertices triangle;
  double t_hit = Aabb::kInf, t_plane = 0.0;
};

GrazedBeyondPlane find_grazed(double p) {
  Rng rng(20);
  const double beyond = std::nextafter(p, 2 * p);
  for (int tries = 0; tries < 1000000; ++tries) {
    GrazedBeyondPlane g;
    const double turn = rng.uniform(0, 3), y = rng.uniform(-0.1, 0.1);
    const Vec3d edge_point{beyond, y, rng.uniform(-0.1, 0.1)};
    const Vec3d edge{0, std::cos(turn), std::sin(turn)};
    g.ray.dir = Vec3d{1, 0.2, 0.2} + random_point(rng, 1.0);
    const Vec3d aside = random_point(rng, 0.05);
    g.triangle = {edge_point - edge, edge_point + edge, edge_point + 0.5 * g.ray.dir + aside};
    g.ray.org = edge_point - 0.75 * g.ray.dir;
    if (g.ray.dir.x < 0.2 || g.triangle.c.x <= beyond) continue;
    const PreparedRay prepared(g.ray, {Aabb{{0, -5, -5}, {2, 5, 5}}});
    const auto hit = intersect(prepared, g.triangle);
    g.t_plane = prepared.plane_first(0, p);
    if (!hit || hit->t >= lowered(g.t_plane, 0x1p-48)) continue;
    g.t_hit = hit->t;
    return g;
  }
  return {};
}

TEST(Grid, LooksIntoACellThatBeginsBeyondTheBestHitByLessThanTheErrorOfT) {
  const double p = UniformCells({{0, -5, -5}, {2, 5, 5}}, {2, 1, 1}).plane(0, 1);
  const GrazedBeyondPlane g = find_grazed(p);
  ASSERT_LT(g.t_hit, g.t_plane);
  // A wall before the plane, hit between the rounded t of the grazed triangle and the plane.
  const double t_wall = 0.5 * (g.t_hit + g.t_plane), x = g.ray.org.x + t_wall * g.ray.dir.x;
  const TriangleVertices& t = g.triangle;
  const ScenePtr scene = scene_of({t.a,
                                   t.b,
                                   t.c,
                                   {x, -3, -3},
                                   {x, 3, -3},
                                   {x, 0, 3},  //
                                   {0, -5, -5},
                                   {2, 5, -5},
                                   {2, -5, -5},
                                   {0, 5, 5},
                                   {2, 5, 5},
                                   {0, -5, 5}});
  std::vector<Hit> hits(1), expected(1);
  build(scene, "brute_force")->closest_hit(make_batch(std::vector<Ray>{g.ray}), expected);
  ASSERT_EQ(expected[0].id.prim, 0u);
  build(scene, "grid:resolution=fixed,nx=2,ny=1,nz=1")
      ->closest_hit(make_batch(std::vector<Ray>{g.ray}), hits);
  EXPECT_TRUE(is_same_hit(hits[0], expected[0]));
}

TEST(Grid, AnOutlierDoesNotMakeItLarge) {
  std::vector<Vec3d> vertices = soup(500, 0.01, 6);
  for (const double s : {0.0, 1.0, 2.0}) vertices.push_back({1e30 + s * 1e15, s * s * 1e15, 1e9});
  const ScenePtr scene = scene_of(vertices);
  for (const char* spec : {"grid", "grid:resolution=woo", "grid:exact=false"}) {
    const auto grid = build(scene, spec);
    EXPECT_LE(grid->report().leaves, 4 * 4 * 501u) << spec;
    ASSERT_NO_THROW(grid->validate());
  }
}

TEST(Grid, LongPrimitivesMakeItCoarser) {
  const ScenePtr scene = scene_of(soup(3000, 3.0, 7));
  for (const char* spec : {"grid:density=16", "grid:density=16,exact=false"}) {
    const auto grid = build(scene, spec);
    EXPECT_LE(grid->report().references, 16u * 16 * 3000) << spec;
    EXPECT_LT(grid->report().leaves, 16u * 3000) << spec;
  }
}

TEST(Grid, HoldsTheResolutionItIsGiven) {
  const ScenePtr scene = scene_of(soup(100, 0.5, 8));
  const auto report = build(scene, "grid:resolution=fixed,nx=5,ny=6,nz=7")->report();
  EXPECT_EQ(report.leaves, 210u);
  EXPECT_EQ(report.nodes, 210u);
  EXPECT_LE(build(scene, "grid:resolution=fixed,nx=50,ny=60,nz=70,max_cells=64")->report().leaves,
            64u);
  EXPECT_LE(build(scene, "grid:density=1000,max_cells=64")->report().leaves, 64u);
}

TEST(Grid, ExactVoxelisationAndMailboxSaveTests) {
  const ScenePtr scene = scene_of(soup(2000, 0.2, 9));
  Rng rng(10);
  std::vector<Ray> rays;
  for (int i = 0; i < 500; ++i) rays.push_back({random_point(rng, 2.0), random_point(rng, 1.0)});
  BatchContext counting;
  counting.count_work = true;
  std::vector<Hit> hits(rays.size());
  const auto work = [&](const char* spec) {
    return build(scene, spec)->closest_hit(make_batch(rays), hits, counting).counters;
  };
  const Counters both = work("grid"), boxes = work("grid:exact=false"),
                 forgetful = work("grid:mailbox=false");
  EXPECT_LT(both.primitives, boxes.primitives);
  EXPECT_LT(both.primitives, forgetful.primitives);
  EXPECT_EQ(both.traversal_steps, forgetful.traversal_steps);
  EXPECT_EQ(both.leaves, both.traversal_steps);
  EXPECT_LT(both.empty_leaves, both.leaves);
  EXPECT_GT(both.empty_leaves, 0u);
}

TEST(Grid, StopsSoonAfterTheFirstHit) {
  const ScenePtr scene = scene_of(soup(2000, 0.2, 11));
  BatchContext counting;
  counting.count_work = true;
  Rng rng(12);
  std::vector<Ray> rays;
  for (int i = 0; i < 200; ++i) rays.push_back({random_point(rng, 0.5), random_point(rng, 1.0)});
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint32_t> counts(rays.size());
  const auto grid = build(scene, "grid");
  const auto first = grid->closest_hit(make_batch(rays), hits, counting).counters;
  const auto all = grid->count_hits(make_batch(rays), counts, counting).counters;
  EXPECT_LT(3 * first.traversal_steps, 2 * all.traversal_steps);
}

TEST(Grid, HonoursMemoryLimitAndCancelling) {
  const ScenePtr scene = scene_of(soup(500, 0.5, 13));
  BuildContext tight;
  tight.memory_limit = 10000;
  EXPECT_THROW(build(scene, "grid", tight), Error);
  BuildContext cancelled;
  cancelled.progress = [](double, std::string_view stage) { return stage != "listing references"; };
  EXPECT_THROW(build(scene, "grid", cancelled), Error);
}

TEST(Grid, OfNothingHitsNothing) {
  const ScenePtr scene = scene_of({});
  const auto grid = build(scene, "grid");
  ASSERT_NO_THROW(grid->validate());
  std::vector<Hit> hits(1);
  grid->closest_hit(make_batch(std::vector<Ray>{{{0, 0, 0}, {1, 0, 0}}}), hits);
  EXPECT_FALSE(hits[0].is_hit());
  EXPECT_EQ(grid->report().references, 0u);
}

TEST(Grid, ValidateNoticesWhatIsMissingOrTooMuch) {
  const ScenePtr scene = scene_of(soup(100, 0.5, 14));
  for (const bool exact : {false, true}) {
    GridOptions options;
    options.exact = exact;
    const Grid grid(*scene, options, {});
    ASSERT_NO_THROW(grid.validate(*scene));
    const auto refuses = [&](auto change) {
      EXPECT_THROW(grid.validate(Doctored(*scene, change)), std::logic_error);
    };
    refuses([](std::uint32_t i, Aabb box) { return i == 7 ? Aabb{} : box; });
    refuses([](std::uint32_t i, Aabb box) {
      if (i == 7) box.hi.x = 100;
      return i == 7 ? Aabb{box.hi, box.hi} : box;
    });
    refuses([&](std::uint32_t i, Aabb box) { return i == 7 ? Aabb{box.lo, box.lo} : box; });
    const Grid fewer(Doctored(*scene, [](std::uint32_t i, Aabb b) { return i == 7 ? Aabb{} : b; }),
                     options, {});
    EXPECT_THROW(fewer.validate(*scene), std::logic_error);
  }
}

}  // namespace
}  // namespace strahl
