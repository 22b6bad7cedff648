#include <cmath>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/bounds/convex_hull.h>

// The comparison with CGAL is tests/numeric/bounds_cgal_test.cpp.
namespace strahl {
namespace {

TEST(ConvexHull, OfAGridIsItsCube) {
  std::vector<Vec3d> points;
  for (int i = 0; i < 64; ++i) points.push_back(Vec3d(Vec3<int>{i & 3, i >> 2 & 3, i >> 4}));
  const auto hull = convex_hull(points);
  ASSERT_TRUE(hull.has_value());
  EXPECT_EQ(hull->vertices, (std::vector<std::uint32_t>{0, 3, 12, 15, 48, 51, 60, 63}));
  double volume = 0.0;
  for (const auto& [a, b, c] : hull->triangles)
    volume += dot(points[a], cross(points[b], points[c])) / 6.0;
  EXPECT_NEAR(volume, 27.0, 1e-12);  // outward, closed
}

TEST(ConvexHull, NeedsAVolume) {
  EXPECT_FALSE(convex_hull({}).has_value());
  EXPECT_FALSE(convex_hull(std::vector<Vec3d>(3)).has_value());
  EXPECT_FALSE(convex_hull(std::vector<Vec3d>(20)).has_value());
  std::vector<Vec3d> flat, line;
  for (int i = 0; i < 20; ++i) {
    flat.push_back({std::cos(i), std::sin(i), 0.5 * std::cos(i)});
    line.push_back({1.0 * i, 2.0 * i, 3.0 * i});
  }
  EXPECT_FALSE(convex_hull(flat).has_value());
  EXPECT_FALSE(convex_hull(line).has_value());
}

TEST(ConvexHull, CountsDuplicatesOnce) {
  std::vector<Vec3d> points;
  for (int i = 0; i < 24; ++i)
    points.push_back({i & 1 ? 1.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0});
  const auto hull = convex_hull(points);
  ASSERT_TRUE(hull.has_value());
  EXPECT_EQ(hull->vertices.size(), 8u);
}

double area(const std::vector<Vec2d>& polygon) {
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    sum += 0.5 * (a.x * b.y - a.y * b.x);
  }
  return sum;
}

TEST(ConvexPolygon, GoesAroundTheCornersOnly) {
  const auto square = convex_polygon(
      {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}, {1, 1}, {2, 2}});
  EXPECT_EQ(square.size(), 4u);
  EXPECT_EQ(area(square), 4.0);
  EXPECT_EQ(convex_polygon({{1, 1}, {1, 1}}).size(), 1u);
  EXPECT_EQ(convex_polygon({{0, 0}, {1, 1}, {2, 2}, {3, 3}}).size(), 2u);
  EXPECT_TRUE(convex_polygon({}).empty());
}

TEST(ConvexPolygon, HasEveryPointOnItsLeft) {
  Rng rng(1);
  for (int round = 0; round < 100; ++round) {
    std::vector<Vec2d> points;
    for (int i = 0; i < 30; ++i)
      points.push_back({std::floor(rng.uniform(0, 9)), std::floor(rng.uniform(0, 9))});
    const auto polygon = convex_polygon(points);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      for (const Vec2d& p : points)
        EXPECT_GE((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x), 0.0);
    }
  }
}

}  // namespace
}  // namespace strahl
