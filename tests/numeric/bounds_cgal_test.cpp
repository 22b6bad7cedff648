// Minimal spheres and convex hulls of bounding volumes against CGAL's, on random and real points.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Min_sphere_of_points_d_traits_3.h>
#include <CGAL/Min_sphere_of_spheres_d.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tests/support/parts.h>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/bounds/convex_hull.h>
#include <strahl/bounds/minimal_ball.h>

namespace strahl::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalPoint = Kernel::Point_3;
using CgalSphere =
    CGAL::Min_sphere_of_spheres_d<CGAL::Min_sphere_of_points_d_traits_3<Kernel, double>>;

std::vector<CgalPoint> cgal_points(const std::vector<Vec3d>& points) {
  std::vector<CgalPoint> out;
  for (const Vec3d& p : points) out.emplace_back(p.x, p.y, p.z);
  return out;
}

Vec3d random_point(Rng& rng) {
  const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1);
  return {x, y, rng.uniform(-1, 1)};
}

/// Clouds in a cube, on a sphere, in a plane, on a line, on a grid, flat ones.
std::vector<std::vector<Vec3d>> clouds() {
  Rng rng(1);
  std::vector<std::vector<Vec3d>> all(7);
  for (int i = 0; i < 300; ++i) {
    const Vec3d p = random_point(rng);
    all[0].push_back(p);
    all[1].push_back(unit(p));
    all[2].push_back({p.x, p.y, 0.5 * p.x + 0.25 * p.y});
    all[3].push_back(p.x * Vec3d{1, 0.5, 0.25});
    all[4].push_back({std::round(2 * p.x), std::round(2 * p.y), std::round(2 * p.z)});
    all[5].push_back({p.x, p.y, 1e-9 * p.z});
    all[6].push_back(1e3 * unit(p) + Vec3d{1e6, 0, 0});
  }
  return all;
}

void expect_sphere_of_cgal(const std::vector<Vec3d>& points) {
  const std::vector<CgalPoint> theirs = cgal_points(points);
  CgalSphere sphere(theirs.begin(), theirs.end());
  const Ball ours = minimal_ball(points);
  double size = 0.0;
  for (const Vec3d& p : points) size = std::max(size, norm_max(p));
  EXPECT_NEAR(ours.radius, sphere.radius(), 1e-12 * size);
  for (const Vec3d& p : points) EXPECT_LE(length(p - ours.center), ours.radius * (1 + 1e-14));
}

TEST(MinimalBall, AgreesWithCgal) {
  for (const std::vector<Vec3d>& points : clouds()) expect_sphere_of_cgal(points);
  Rng rng(2);
  for (int round = 0; round < 300; ++round) {
    std::vector<Vec3d> few;
    for (int i = 0; i < round % 7 + 1; ++i) few.push_back(random_point(rng));
    expect_sphere_of_cgal(few);
  }
}

TEST(MinimalBall, OfRealPartsAgreesWithCgal) {
  STRAHL_REQUIRE_SHARED("scenes");
  for (const std::string& part : real_parts()) expect_sphere_of_cgal(vertices_of(part));
}

TEST(MinimalBall, OfBallsAgreesWithCgal) {
  using Traits = CGAL::Min_sphere_of_spheres_d_traits_3<Kernel, double>;
  Rng rng(3);
  for (int round = 0; round < 200; ++round) {
    std::vector<Ball> balls;
    std::vector<Traits::Sphere> theirs;
    for (int i = 0; i < round % 40 + 1; ++i) {
      balls.push_back({random_point(rng), rng.uniform(0, round % 3 == 0 ? 0.01 : 1.0)});
      const Ball& b = balls.back();
      theirs.emplace_back(CgalPoint(b.center.x, b.center.y, b.center.z), b.radius);
    }
    CGAL::Min_sphere_of_spheres_d<Traits> sphere(theirs.begin(), theirs.end());
    const Ball ours = minimal_ball({}, balls);
    EXPECT_NEAR(ours.radius, sphere.radius(), 1e-10) << balls.size();
    for (const Ball& b : balls)
      EXPECT_LE(length(b.center - ours.center) + b.radius, ours.radius * (1 + 1e-14));
  }
}

using Coordinates = std::tuple<double, double, double>;

std::set<Coordinates> cgal_hull(const std::vector<Vec3d>& points) {
  const std::vector<CgalPoint> theirs = cgal_points(points);
  CGAL::Surface_mesh<CgalPoint> hull;
  CGAL::convex_hull_3(theirs.begin(), theirs.end(), hull);
  std::set<Coordinates> vertices;
  for (const auto v : hull.vertices())
    vertices.insert({hull.point(v).x(), hull.point(v).y(), hull.point(v).z()});
  return vertices;
}

/// Vertices that only one of the two hulls has must not stick out of the other by more than
/// rounding: qhull merges what CGAL tells apart exactly.
void expect_hull_of_cgal(const std::vector<Vec3d>& points, bool exactly) {
  const std::optional<ConvexHull> hull = convex_hull(points);
  ASSERT_TRUE(hull.has_value());
  std::set<Coordinates> ours;
  for (const std::uint32_t v : hull->vertices) ours.insert({points[v].x, points[v].y, points[v].z});
  const std::set<Coordinates> theirs = cgal_hull(points);
  if (exactly) {
    EXPECT_EQ(ours, theirs);
  }
  double size = 0.0;
  for (const Vec3d& p : points) size = std::max(size, norm_max(p - points[0]));
  for (const auto& [x, y, z] : theirs) {
    if (ours.contains({x, y, z})) continue;
    for (const auto& [a, b, c] : hull->triangles) {
      const Vec3d n = cross(points[b] - points[a], points[c] - points[a]);
      if (length(n) < 1e-9 * size * size) continue;
      EXPECT_LE(dot(Vec3d{x, y, z} - points[a], unit(n)), 1e-12 * size);
    }
  }
}

TEST(ConvexHull, HasTheVerticesOfCgals) {
  const std::vector<std::vector<Vec3d>> all = clouds();
  expect_hull_of_cgal(all[0], true);
  expect_hull_of_cgal(all[1], true);
  expect_hull_of_cgal(all[6], true);
  expect_hull_of_cgal(all[4], false);
  EXPECT_FALSE(convex_hull(all[2]).has_value());
  EXPECT_FALSE(convex_hull(all[3]).has_value());
}

TEST(ConvexHull, OfRealPartsHasTheVerticesOfCgals) {
  STRAHL_REQUIRE_SHARED("scenes");
  for (const std::string& part : real_parts()) {
    SCOPED_TRACE(part);
    expect_hull_of_cgal(vertices_of(part), false);
  }
}

}  // namespace
}  // namespace strahl::test
