// Expected answers of other projects' tests, restated: ray sets of trimesh (with nearest hits found
// by brute force in double), the literal cases of Open3D's ray casting and of CGAL's AABB tree.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <tests/support/queries.h>
#include <tests/support/shared.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <strahl/io/load.h>

namespace strahl::test {
namespace {

/// One ray against every structure: all hits, sorted, the same everywhere.
std::vector<Hit> hits_everywhere(const std::shared_ptr<const Scene>& scene, const Ray& ray) {
  std::vector<Hit> first;
  for (const auto& structure : build_all(scene)) {
    const AllHits all = all_hits(*structure, make_batch({&ray, 1}));
    if (structure->spec() == "brute_force") first = all.hits;
    EXPECT_EQ(all.hits.size(), first.size()) << structure->spec();
    for (std::size_t i = 0; i < std::min(all.hits.size(), first.size()); ++i)
      EXPECT_TRUE(same_bits(all.hits[i], first[i])) << structure->spec();
    EXPECT_EQ(any_hits(*structure, make_batch({&ray, 1}))[0], !first.empty());
    EXPECT_EQ(structure->closest_hit(ray).is_hit(), !first.empty());
  }
  return first;
}

std::vector<double> parameters(const std::vector<Hit>& hits) {
  std::vector<double> t;
  for (const Hit& hit : hits) t.push_back(hit.t);
  return t;
}

// --- trimesh ------------------------------------------------------------------------------------

constexpr const char* kTrimesh = "reference/trimesh_rays";

struct TrimeshRow {
  bool is_hit;
  std::uint32_t count;
  double t;
  std::uint32_t triangle;
};

/// mesh,ray,hit,n_hits,t_nearest,triangle_index_in_file_order,ambiguous, in order of rays.
std::vector<TrimeshRow> trimesh_rows(const std::string& mesh) {
  std::vector<TrimeshRow> rows;
  std::ifstream file(shared_dir() / kTrimesh / "truth_bruteforce.csv");
  for (std::string line; std::getline(file, line);) {
    std::vector<std::string> cells;
    std::istringstream text(line + ",");
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    if (cells.at(0) != mesh) continue;
    const auto number = [&](std::size_t i) { return std::strtod(cells[i].c_str(), nullptr); };
    rows.push_back({cells.at(2) == "1", static_cast<std::uint32_t>(number(3)), number(4),
                    static_cast<std::uint32_t>(number(5))});
  }
  return rows;
}

std::vector<Ray> trimesh_rays(const std::string& mesh) {
  std::ifstream file(shared_dir() / kTrimesh / "ray_data.json");
  const auto rays = nlohmann::json::parse(file)["rays"][mesh];
  const auto vec = [](const nlohmann::json& v) {
    return Vec3d{v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
  };
  std::vector<Ray> made;
  for (std::size_t i = 0; i < rays["ray_origins"].size(); ++i)
    made.push_back({vec(rays["ray_origins"][i]), vec(rays["ray_directions"][i])});
  return made;
}

struct TrimeshCase {
  const char* mesh;
  std::uint32_t triangles;
  int hits;
};
void PrintTo(const TrimeshCase& c, std::ostream* out) { *out << c.mesh; }

class Trimesh : public testing::TestWithParam<TrimeshCase> {};

TEST_P(Trimesh, EveryStructureFindsTheHitsOfItsRayData) {
  STRAHL_REQUIRE_SHARED(kTrimesh);
  const TrimeshCase& c = GetParam();
  const auto scene =
      std::make_shared<const Scene>(load_scene_data((shared_dir() / kTrimesh / c.mesh).string()));
  ASSERT_EQ(scene->size(), c.triangles);
  const std::vector<Ray> rays = trimesh_rays(c.mesh);
  const std::vector<TrimeshRow> rows = trimesh_rows(c.mesh);
  ASSERT_EQ(rays.size(), 1200u);
  ASSERT_EQ(rows.size(), 1200u);
  for (const auto& structure : build_all(scene)) {
    SCOPED_TRACE(structure->spec());
    const std::vector<Hit> hits = closest_hits(*structure, make_batch(rays));
    const std::vector<std::uint32_t> counts = hit_counts(*structure, make_batch(rays));
    int found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      SCOPED_TRACE("ray " + std::to_string(i));
      ASSERT_EQ(hits[i].is_hit(), rows[i].is_hit);
      ASSERT_EQ(counts[i], rows[i].count);
      if (!rows[i].is_hit) continue;
      ++found;
      EXPECT_EQ(hits[i].id.prim, rows[i].triangle);
      EXPECT_NEAR(hits[i].t, rows[i].t, 1e-10 * rows[i].t);
    }
    EXPECT_EQ(found, c.hits);
  }
}

INSTANTIATE_TEST_SUITE_P(RayData, Trimesh,
                         testing::Values(TrimeshCase{"ballA.off", 3796, 344},
                                         TrimeshCase{"featuretype.STL", 3476, 360},
                                         TrimeshCase{"angle_block.STL", 704, 360},
                                         TrimeshCase{"cylinder.stl", 416, 343}),
                         [](const testing::TestParamInfo<TrimeshCase>& i) {
                           const std::string name = i.param.mesh;
                           return name.substr(0, name.find('.'));
                         });

// --- Open3D -------------------------------------------------------------------------------------

std::shared_ptr<const Scene> open3d_triangle() {
  return scene_of(make_mesh(std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {0, 1, 2}));
}

/// Corner i has the bits of i as coordinates; faces outward.
std::shared_ptr<const Scene> unit_box() {
  std::vector<Vec3f> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(
        {static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1), static_cast<float>(i >> 2)});
  return scene_of(
      make_mesh(std::move(corners), {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                     2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5}));
}

TEST(Open3dCases, ATriangleIsHitAtOneAndMissedFromAfar) {
  const auto scene = open3d_triangle();
  EXPECT_EQ(parameters(hits_everywhere(scene, {{0.2, 0.1, 1}, {0, 0, -1}})),
            std::vector<double>{1.0});
  EXPECT_TRUE(hits_everywhere(scene, {{10, 10, 10}, {1, 0, 0}}).empty());
}

TEST(Open3dCases, AnIntervalThatEndsBeforeOrBeginsBehindTheTriangleIsNotOccluded) {
  const auto scene = open3d_triangle();
  const Ray ray{{0.2, 0.1, 1}, {0, 0, -1}};
  Ray near = ray, far = ray, touching = ray;
  near.t_max = 0.5, far.t_min = 1.5, touching.t_min = touching.t_max = 1.0;
  EXPECT_EQ(hits_everywhere(scene, ray).size(), 1u);
  EXPECT_TRUE(hits_everywhere(scene, near).empty());
  EXPECT_TRUE(hits_everywhere(scene, far).empty());
  EXPECT_EQ(hits_everywhere(scene, touching).size(), 1u);  // the interval is closed
}

TEST(Open3dCases, ABoxIsCrossedTwiceOnceAndNeverThroughTheDiagonalsOfItsFaces) {
  const auto scene = unit_box();
  EXPECT_EQ(parameters(hits_everywhere(scene, {{0.5, 0.5, -1}, {0, 0, 1}})),
            (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(parameters(hits_everywhere(scene, {{0.5, 0.5, 0.5}, {0, 0, 1}})),
            std::vector<double>{0.5});
  EXPECT_TRUE(hits_everywhere(scene, {{10, 10, 10}, {1, 0, 0}}).empty());
}

/// Sphere of radius 0.8 about the origin with poles on z: 19 rings of 40 vertices.
std::shared_ptr<const Scene> ringed_sphere() {
  constexpr std::uint32_t kRings = 19, kSpokes = 40;
  std::vector<Vec3f> vertices{Vec3f(Vec3d{0, 0, 0.8}), Vec3f(Vec3d{0, 0, -0.8})};
  for (std::uint32_t r = 1; r <= kRings; ++r)
    for (std::uint32_t s = 0; s < kSpokes; ++s) {
      const double theta = std::numbers::pi * r / (kRings + 1);
      const double phi = 2 * std::numbers::pi * s / kSpokes;
      vertices.push_back(Vec3f(0.8 * Vec3d{std::sin(theta) * std::cos(phi),
                                           std::sin(theta) * std::sin(phi), std::cos(theta)}));
    }
  const auto at = [](std::uint32_t ring, std::uint32_t spoke) {
    return 2 + (ring - 1) * kSpokes + spoke % kSpokes;
  };
  std::vector<std::uint32_t> indices;
  for (std::uint32_t s = 0; s < kSpokes; ++s) {
    indices.insert(indices.end(), {0, at(1, s), at(1, s + 1)});
    indices.insert(indices.end(), {1, at(kRings, s + 1), at(kRings, s)});
    for (std::uint32_t r = 1; r < kRings; ++r)
      indices.insert(indices.end(), {at(r, s), at(r + 1, s), at(r + 1, s + 1),  //
                                     at(r, s), at(r + 1, s + 1), at(r, s + 1)});
  }
  return scene_of(make_mesh(std::move(vertices), std::move(indices)));
}

TEST(Open3dCases, OccupancyOfASphereOnACoarseGridIsTheDistanceFromItsCentre) {
  // The mesh lies between the radii 0.78 and 0.8, the points' distances do not.
  std::vector<Ray> points;
  for (int x = 0; x < 6; ++x)
    for (int y = 0; y < 6; ++y)
      for (int z = 0; z < 6; ++z) {
        const auto at = [](int i) { return 0.88 * (2.0 * i / 5 - 1); };
        points.push_back({{at(x), at(y), at(z)}, {1, 0, 0}});
      }
  for (const auto& structure : build_all(ringed_sphere())) {
    SCOPED_TRACE(structure->spec());
    const std::vector<Side> sides = sides_of(*structure, make_batch(points));
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_EQ(sides[i], length(points[i].org) < 0.79 ? Side::inside : Side::outside) << i;
  }
}

TEST(Open3dCases, AVeryLargeBatchIsAnswered) {
  constexpr std::size_t kRays = 7654321;
  Rng rng(123);
  std::vector<float> numbers(6 * kRays);
  for (float& number : numbers) number = static_cast<float>(rng.uniform());
  RayBatch batch;
  const auto* base = reinterpret_cast<const std::byte*>(numbers.data());
  batch.org = {base, kRays, 6 * sizeof(float), false};
  batch.dir = {base + 3 * sizeof(float), kRays, 6 * sizeof(float), false};
  const auto structure = build(unit_box(), kDefaultSpec);
  std::vector<std::uint8_t> any(kRays);
  EXPECT_EQ(structure->any_hit(batch, any).invalid_rays, 0u);
  // From inside a box every ray leaves through its surface.
  EXPECT_EQ(std::count(any.begin(), any.end(), 1), static_cast<std::ptrdiff_t>(kRays));
}

// --- CGAL ---------------------------------------------------------------------------------------

std::shared_ptr<const Scene> tetrahedron() {
  return std::make_shared<const Scene>(
      load_scene_data(STRAHL_SOURCE_DIR "/tests/data/tetrahedron.off"));
}

TEST(CgalCases, ASegmentCrossesOneFacetOfATetrahedronAndItsLineTwo) {
  const auto scene = tetrahedron();
  const Vec3d p{-0.25, 0.251, 0.255}, q{0.25, 0.253, 0.256};
  EXPECT_EQ(hits_everywhere(scene, {p, q - p, 0.0, 1.0}).size(), 1u);
  EXPECT_EQ(hits_everywhere(scene, {p - 4.0 * (q - p), q - p}).size(), 2u);
}

/// Segments between points of a sphere about the box of the scene, half as large as the box.
std::vector<Ray> chords(const Scene& scene, std::size_t count) {
  Rng rng(5);
  const Aabb box = scene.total_bounds();
  const double radius = 0.5 * length(box.extent());
  const auto point = [&] {
    const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1);
    return box.center() + radius * unit(Vec3d{x, y, rng.uniform(-1, 1)});
  };
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Vec3d p = point(), q = point();
    rays.push_back({p, q - p, 0.0, 1.0});
  }
  return rays;
}

void expect_queries_agree(const std::shared_ptr<const Scene>& scene) {
  const std::vector<Ray> rays = chords(*scene, 1000);
  const auto brute = build(scene, "brute_force");
  const AllHits naive = all_hits(*brute, make_batch(rays));
  ASSERT_GT(naive.hits.size(), scene->size() > 100 ? 500u : 0u);
  for (const auto& structure : build_all(scene)) {
    SCOPED_TRACE(structure->spec());
    const auto first = closest_hits(*structure, make_batch(rays));
    const auto counts = hit_counts(*structure, make_batch(rays));
    const auto any = any_hits(*structure, make_batch(rays));
    const AllHits all = all_hits(*structure, make_batch(rays));
    ASSERT_EQ(all.splits, naive.splits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::span<const Hit> expected = hits_of(naive, i), found = hits_of(all, i);
      ASSERT_EQ(counts[i], expected.size());
      ASSERT_EQ(any[i] != 0, !expected.empty());
      ASSERT_TRUE(std::equal(found.begin(), found.end(), expected.begin(),
                             [](const Hit& a, const Hit& b) { return same_bits(a, b); }));
      ASSERT_TRUE(same_bits(first[i], expected.empty() ? Hit{} : expected.front()));
    }
  }
}

TEST(CgalCases, TheFirstIntersectionIsTheLeastOfAllAndTreesAgreeWithTheNaiveLoop) {
  expect_queries_agree(tetrahedron());
  expect_queries_agree(unit_box());
  expect_queries_agree(ringed_sphere());
}

TEST(CgalCases, RealMeshesToo) {
  STRAHL_REQUIRE_SHARED(kTrimesh);
  for (const char* mesh : {"ballA.off", "angle_block.STL"})
    expect_queries_agree(
        std::make_shared<const Scene>(load_scene_data((shared_dir() / kTrimesh / mesh).string())));
}

TEST(CgalCases, AnEmptySetAndASingleTriangleAreQueried) {
  const Ray ray{{0.25, 0.25, -1}, {0, 0, 1}};
  EXPECT_TRUE(hits_everywhere(std::make_shared<const Scene>(SceneData{}), ray).empty());
  const auto one =
      scene_of(make_mesh(std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}));
  EXPECT_EQ(hits_everywhere(one, ray).size(), 1u);
}

}  // namespace
}  // namespace strahl::test
