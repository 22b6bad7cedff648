// geometry/polygon_test.cpp - counts, coverage and orientation of cut polygons.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/geometry/polygon.h>
#include <strahl/math/orient2d.h>

namespace strahl {
namespace {

using Triple = std::array<std::uint32_t, 3>;
using Triangles = std::vector<Triple>;

Triangles cut(const std::vector<Vec3d>& corners) {
  Triangles triangles;
  triangulate_polygon(corners, triangles);
  return triangles;
}

Point2 flat(const Vec3d& p) { return {p.x, p.y}; }

double area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

double area(const std::vector<Vec3d>& corners) {
  double sum = 0.0;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    sum += area(corners[0], corners[i - 1], corners[i]);
  }
  return sum;
}

// Triangles that all turn the polygon's way and together have its area cover it exactly once.
void expect_covered_once(const std::vector<Vec3d>& corners) {
  const Triangles triangles = cut(corners);
  ASSERT_EQ(triangles.size(), corners.size() - 2);
  const double whole = area(corners);
  double sum = 0.0;
  for (const Triple& t : triangles) {
    const Vec3d &a = corners[t[0]], &b = corners[t[1]], &c = corners[t[2]];
    const int side = orient2d(flat(a), flat(b), flat(c));
    EXPECT_GE(whole > 0 ? side : -side, 0) << t[0] << ' ' << t[1] << ' ' << t[2];
    sum += area(a, b, c);
  }
  EXPECT_NEAR(sum, whole, 1e-9 * std::abs(whole));
}

std::vector<Vec3d> reversed(std::vector<Vec3d> corners) {
  return {corners.rbegin(), corners.rend()};
}

// Star-shaped about the origin with random radii: simple, mostly concave.
std::vector<Vec3d> star(std::size_t corner_count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Vec3d> corners;
  for (std::size_t i = 0; i < corner_count; ++i) {
    const double angle =
        6.283185307179586 * static_cast<double>(i) / static_cast<double>(corner_count);
    const double radius = rng.uniform(0.1, 1.0);
    corners.push_back({radius * std::cos(angle), radius * std::sin(angle), 0.0});
  }
  return corners;
}

TEST(Polygon, FewerThanThreeCornersGiveNothing) {
  EXPECT_TRUE(cut({}).empty());
  EXPECT_TRUE(cut({{0, 0, 0}}).empty());
  EXPECT_TRUE(cut({{0, 0, 0}, {1, 0, 0}}).empty());
}

TEST(Polygon, ATriangleStaysAsItIs) {
  EXPECT_EQ(cut({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}), (Triangles{{0, 1, 2}}));
}

TEST(Polygon, AConvexPolygonFansOutFromItsFirstCornerInBothOrientations) {
  const std::vector<Vec3d> corners{{0, 0, 1}, {2, 0, 1}, {3, 1, 1}, {2, 2, 1}, {0, 2, 1}};
  const Triangles fan{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
  EXPECT_EQ(cut(corners), fan);
  EXPECT_EQ(cut(reversed(corners)), fan);
}

TEST(Polygon, AConvexPolygonWithStraightCornersStillFansOut) {
  EXPECT_EQ(cut({{1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 0}}),
            (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Polygon, ADartIsCutAtItsReflexCorner) {
  const std::vector<Vec3d> dart{{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1, 1, 0}};
  expect_covered_once(dart);
  for (const Triple& t : cut(dart)) {
    EXPECT_TRUE(t[0] == 3 || t[1] == 3 || t[2] == 3);
  }
}

TEST(Polygon, ABoundaryThatWindsTwiceIsNotTakenForConvex) {
  // A pentagram turns the same way at every corner.
  std::vector<Vec3d> corners;
  for (int i = 0; i < 5; ++i)
    corners.push_back({std::cos(i * 2.5132741), std::sin(i * 2.5132741), 0});
  const Triangles fan{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
  EXPECT_EQ(cut(corners).size(), 3U);
  EXPECT_NE(cut(corners), fan);
}

TEST(Polygon, ConvexityIsDecidedExactlyWhereRoundingCannotSeeIt) {
  // The third corner lies one unit in the last place inside or outside the line of its neighbours.
  const double third = 1.0 / 3.0;
  for (const double toward : {0.0, 1.0}) {
    const double y = std::nextafter(third, toward);
    expect_covered_once({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {third, y, 0}});
  }
  const Triangles fan{{0, 1, 2}, {0, 2, 3}};
  const auto with = [&](double y) { return cut({{third, y, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}}); };
  EXPECT_EQ(with(std::nextafter(third, 1.0)), fan);
  // Reflex: a fan from that corner is the right cut, one from corner 1 would not be; from 0 to 2.
  EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {third, std::nextafter(third, 1.0), 0}}), fan);
  EXPECT_NE(cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {third, std::nextafter(third, 0.0), 0}}), fan);
}

TEST(Polygon, RandomStarsAreCoveredOnceInBothOrientations) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const std::vector<Vec3d> corners = star(4 + seed % 60, seed);
    expect_covered_once(corners);
    expect_covered_once(reversed(corners));
  }
}

TEST(Polygon, AGearIsCoveredOnce) {
  std::vector<Vec3d> corners;
  for (int i = 0; i < 144; ++i) {
    const double radius = (i / 2) % 2 == 0 ? 1.0 : 0.9, angle = i * 0.043633231;
    corners.push_back({radius * std::cos(angle), radius * std::sin(angle), 0.0});
  }
  expect_covered_once(corners);
}

TEST(Polygon, ASquareWithAHoleJoinedByABridgeIsCoveredOnce) {
  expect_covered_once({{0, 0, 0},
                       {4, 0, 0},
                       {4, 4, 0},
                       {0, 4, 0},
                       {0, 0, 0},
                       {1, 1, 0},
                       {1, 3, 0},
                       {3, 3, 0},
                       {3, 1, 0},
                       {1, 1, 0}});
}

TEST(Polygon, AHoleThatTouchesACornerFromInsideIsLeftOpen) {
  // The hole has a corner at the polygon's corner (0,0); the bridge joins it elsewhere.
  expect_covered_once({{0, 0, 0},
                       {8, 0, 0},
                       {8, 8, 0},
                       {5, 5, 0},
                       {4, 3, 0},
                       {0, 0, 0},
                       {3, 4, 0},
                       {5, 5, 0},
                       {8, 8, 0},
                       {0, 8, 0}});
}

TEST(Polygon, ACutNeverRunsThroughAnotherCorner) {
  // (2,2) lies on the diagonal that would cut off corner 0; the triangle left over had no area.
  const std::vector<Vec3d> corners{{4, 0, 0}, {4, 4, 0}, {2, 2, 0}, {0, 4, 0}, {0, 0, 0}};
  expect_covered_once(corners);
  for (const Triple& t : cut(corners)) {
    EXPECT_NE(area(corners[t[0]], corners[t[1]], corners[t[2]]), 0.0);
  }
}

TEST(Polygon, RepeatedCornersKeepTheCountAndTheCover) {
  expect_covered_once({{0, 0, 0}, {0, 0, 0}, {2, 1, 0}, {2, 1, 0}, {0, 2, 0}, {1, 1, 0}});
}

TEST(Polygon, PlanesAtAnyAngleKeepTheOrientation) {
  // The dart, lifted into planes whose normals have each axis as the largest component.
  const std::vector<Vec3d> dart{{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1, 1, 0}};
  const Triangles expected = cut(dart);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Vec3d> turned(dart.size());
    for (std::size_t i = 0; i < dart.size(); ++i) {
      turned[i][(axis + 1) % 3] = dart[i].x;
      turned[i][(axis + 2) % 3] = dart[i].y;
      turned[i][axis] = 0.25 * dart[i].x - 0.5 * dart[i].y;
    }
    EXPECT_EQ(cut(turned), expected) << "axis " << axis;
  }
}

TEST(Polygon, HopelessPolygonsStillGiveTheCount) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), huge = 1e308;
  EXPECT_EQ(cut({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).size(), 2U);
  EXPECT_EQ(cut({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}).size(), 3U);
  EXPECT_EQ(cut({{0, 0, 0}, {nan, 0, 0}, {1, 1, 0}, {0, 1, 0}}).size(), 2U);
  EXPECT_EQ(cut({{-huge, 0, 0}, {huge, 0, 0}, {huge, huge, 0}, {-huge, huge, 0}}).size(), 2U);
  EXPECT_EQ(cut({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}}).size(), 2U);
  EXPECT_EQ(cut({{0, 0, 0}, {3, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 0, 0}}).size(), 4U);
}

TEST(Polygon, AppendsBehindWhatIsThere) {
  Triangles triangles{{7, 8, 9}};
  triangulate_polygon(std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, triangles);
  EXPECT_EQ(triangles, (Triangles{{7, 8, 9}, {0, 1, 2}}));
}

// A comb whose teeth all start from one long edge.
std::vector<Vec3d> comb(int teeth) {
  std::vector<Vec3d> corners{{2.0 * teeth, -1, 0}};
  for (int i = teeth; i > 0; --i) {
    corners.push_back({2.0 * i - 1, 100, 0});
    corners.push_back({2.0 * i - 2, 0, 0});
  }
  corners.push_back({0, -1, 0});
  return corners;
}

TEST(Polygon, ManyConcaveCornersAreCoveredOnce) {
  expect_covered_once(star(5000, 7));
  expect_covered_once(comb(2500));
  expect_covered_once(star(50000, 8));
}

}  // namespace
}  // namespace strahl
