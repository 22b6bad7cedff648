// Where points lie: `inside` on dense grids around closed meshes equals the exact parity of
// crossings in other directions, and points of the surface are found to be on it.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <tests/numeric/solids.h>
#include <tests/support/queries.h>
#include <tests/support/shared.h>

#include <gtest/gtest.h>

#include <strahl/geometry/triangle.h>
#include <strahl/io/generators.h>
#include <strahl/io/load.h>

namespace strahl::test {
namespace {

constexpr int kGrid = 64;
constexpr std::size_t kBrutePoints = 400;
/// Axis-parallel ones run in planes and along edges of modelled parts.
constexpr std::array<Vec3d, 3> kDirections{{{1, 0, 0}, {0, -1, 1}, {-0.3, 0.5, 0.1}}};

/// Grid points around the box; its margin of 1/64 is not met by coordinates that people choose.
std::vector<Ray> grid_around(const Aabb& box) {
  const Vec3d margin = box.extent() / 64.0, lo = box.lo - margin;
  const Vec3d step = (box.extent() + 2.0 * margin) / double{kGrid - 1};
  std::vector<Ray> rays;
  for (int x = 0; x < kGrid; ++x)
    for (int y = 0; y < kGrid; ++y)
      for (int z = 0; z < kGrid; ++z)
        rays.push_back({lo + Vec3d{x * step.x, y * step.y, z * step.z}, {1, 0, 0}});
  return rays;
}

/// `count` of the points in equal steps and shifted, so that no grid line is favoured; brute force
/// is slow.
std::vector<Ray> thinned(const std::vector<Ray>& points, std::size_t count) {
  std::vector<Ray> some;
  const std::size_t step = std::max<std::size_t>(points.size() / count, 1);
  for (std::size_t i = 0; i < points.size(); i += step)
    some.push_back(points[std::min(points.size() - 1, i + 37 * (i / step) % step)]);
  return some;
}

bool is_on_any_triangle(const Scene& scene, const Vec3d& point) {
  const TriangleMesh& mesh = scene.geometries().front().mesh;
  for (std::size_t i = 0; i < mesh.size(); ++i)
    if (is_on_triangle(point, mesh[i])) return true;
  return false;
}

/// Whether the points are inside by parity along each direction; all directions must agree.
std::vector<bool> parities(const Accelerator& counter, std::vector<Ray> points,
                           const std::vector<Side>& sides) {
  std::vector<bool> is_inside(points.size());
  for (const Vec3d& dir : kDirections) {
    for (Ray& point : points) point.dir = dir;
    const std::vector<std::uint32_t> counts = hit_counts(counter, make_batch(points));
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (dir == kDirections.front()) is_inside[i] = counts[i] % 2 == 1;
      if (sides[i] == Side::on_surface) continue;
      EXPECT_EQ(is_inside[i], counts[i] % 2 == 1) << "point " << i;
    }
  }
  return is_inside;
}

/// Every structure gives these sides; brute force is asked about some of the points.
void expect_sides(const std::shared_ptr<const Scene>& scene, const std::vector<Ray>& points,
                  const std::vector<Side>& expected) {
  for (const auto& structure : build_all(scene)) {
    SCOPED_TRACE(structure->spec());
    const bool is_brute = structure->spec() == "brute_force";
    const std::size_t step = is_brute ? points.size() / kBrutePoints + 1 : 1;
    std::vector<Ray> some;
    for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i]);
    const std::vector<Side> sides = sides_of(*structure, make_batch(some));
    for (std::size_t i = 0; i < some.size(); ++i)
      ASSERT_EQ(sides[i], expected[i * step]) << "point " << i * step;
  }
}

void expect_inside_is_parity(const std::shared_ptr<const Scene>& scene) {
  const std::vector<Ray> points = grid_around(scene->total_bounds());
  const auto counter = build(scene, kDefaultSpec);
  const std::vector<Side> sides = sides_of(*counter, make_batch(points));
  const std::vector<bool> is_inside = parities(*counter, points, sides);
  std::size_t inside = 0, on_surface = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    inside += sides[i] == Side::inside, on_surface += sides[i] == Side::on_surface;
    if (sides[i] == Side::on_surface) {
      ASSERT_TRUE(is_on_any_triangle(*scene, points[i].org)) << "point " << i;
    } else {
      ASSERT_EQ(sides[i] == Side::inside, is_inside[i]) << "point " << i;
    }
  }
  EXPECT_GT(inside, points.size() / 20);
  EXPECT_LT(on_surface, points.size() / 100);
  expect_sides(scene, points, sides);
}

/// a + b without rounding, else NaN.
double exact_sum(double a, double b) {
  const double sum = a + b, other = sum - a;
  const bool is_exact = (a - (sum - other)) + (b - other) == 0.0;
  return is_exact ? sum : std::nan("");
}
Vec3d exact_sum(const Vec3d& a, const Vec3d& b) {
  return {exact_sum(a.x, b.x), exact_sum(a.y, b.y), exact_sum(a.z, b.z)};
}

/// Corners, and middles of edges and faces ((2a + b + c) / 4) that doubles hold exactly.
std::vector<Ray> surface_points(const TriangleMesh& mesh) {
  std::vector<Ray> points;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const TriangleVertices t = mesh[i];
    const Vec3d ab = exact_sum(t.a, t.b), ac = exact_sum(t.a, t.c);
    for (const Vec3d& p : {t.a, 0.5 * ab, 0.25 * exact_sum(ab, ac)})
      if (std::isfinite(norm1(p))) points.push_back({p, {1, 0, 0}});
  }
  return points;
}

void expect_surface_is_found(const std::shared_ptr<const Scene>& scene) {
  const std::vector<Ray> all = surface_points(scene->geometries().front().mesh);
  ASSERT_GT(all.size(), 2 * scene->size());
  for (const auto& structure : build_all(scene)) {
    SCOPED_TRACE(structure->spec());
    const bool is_brute = structure->spec() == "brute_force";
    const std::vector<Ray> points = is_brute ? thinned(all, kBrutePoints) : all;
    const std::vector<Side> sides = sides_of(*structure, make_batch(points));
    for (std::size_t i = 0; i < points.size(); ++i)
      ASSERT_EQ(sides[i], Side::on_surface) << "point " << i;
  }
}

std::shared_ptr<const Scene> icosphere() {
  return std::make_shared<const Scene>(generate_scene("icosphere:4"));
}
std::shared_ptr<const Scene> ring() { return scene_of(torus(1.0, 0.35, 48, 24)); }
std::shared_ptr<const Scene> printed_part() {
  return std::make_shared<const Scene>(
      load_scene_data((shared_dir() / "scenes/extruder-body.stl").string()));
}

TEST(Inside, EqualsExactParityAroundAnIcosphere) { expect_inside_is_parity(icosphere()); }
TEST(Inside, EqualsExactParityAroundATorus) { expect_inside_is_parity(ring()); }
TEST(Inside, EqualsExactParityAroundAPrintedPart) {
  STRAHL_REQUIRE_SHARED("scenes/extruder-body.stl");
  expect_inside_is_parity(printed_part());
}

TEST(Inside, CornersAndExactMiddlesOfEdgesAndFacesAreOnTheSurface) {
  expect_surface_is_found(icosphere());
  expect_surface_is_found(ring());
  expect_surface_is_found(scene_of(as_mesh(integer_cube(2))));
}
TEST(Inside, TheSurfaceOfAPrintedPartIsFound) {
  STRAHL_REQUIRE_SHARED("scenes/extruder-body.stl");
  expect_surface_is_found(printed_part());
}

TEST(Inside, PointsOneUlpFromAFaceAreNotOnIt) {
  for (const auto& structure : build_all(scene_of(as_mesh(integer_cube(2))))) {
    const std::vector<Ray> points{{{std::nextafter(2.0, 3.0), 0.3, 0.4}, {1, 0, 0}},
                                  {{std::nextafter(2.0, 1.0), 0.3, 0.4}, {1, 0, 0}},
                                  {{0.3, -2.0, 0.4}, {1, 0, 0}}};
    EXPECT_EQ(sides_of(*structure, make_batch(points)),
              (std::vector<Side>{Side::outside, Side::inside, Side::on_surface}))
        << structure->spec();
  }
}

}  // namespace
}  // namespace strahl::test
