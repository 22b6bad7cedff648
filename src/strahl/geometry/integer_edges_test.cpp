#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/geometry/edge_signs.h>
#include <strahl/geometry/integer_edges.h>
#include <strahl/geometry/triangle.h>

namespace strahl {
namespace {

/// A point of a lattice: `steps` on either side of 0 in units of `unit`.
Vec3d lattice_point(Rng& rng, double steps, double unit) {
  const auto one = [&] { return unit * std::round(rng.uniform(-steps, steps)); };
  const double x = one(), y = one(), z = one();
  return {x, y, z};
}

struct Edge {
  int integer, exact;
};
std::array<Edge, 3> edges_of(const Vec3d& org, const Vec3d& dir, const TriangleVertices& t) {
  const std::optional<IntegerEdges> integers = IntegerEdges::make(org, dir, t);
  if (!integers) {
    ADD_FAILURE() << "refused";
    return {};
  }
  return {{{integers->ab(), exact_edge_sign(org, dir, t.a, t.b)},
           {integers->bc(), exact_edge_sign(org, dir, t.b, t.c)},
           {integers->ca(), exact_edge_sign(org, dir, t.c, t.a)}}};
}

/// The origin on the edge's line is left to the exact rule; everything else must agree.
void expect_exact(const Vec3d& org, const Vec3d& dir, const TriangleVertices& t, int& on_line) {
  for (const Edge& edge : edges_of(org, dir, t)) {
    if (edge.integer == 0)
      ++on_line;
    else
      ASSERT_EQ(edge.integer, edge.exact) << dir.x << ' ' << dir.y << ' ' << dir.z;
  }
}

/// Few points: most rays pass through corners, along edges or in the triangle's plane.
TEST(IntegerEdges, AreThoseOfTheExactRuleOnSmallLattices) {
  Rng rng(1);
  int on_line = 0;
  for (int i = 0; i < 40000; ++i) {
    const TriangleVertices t{lattice_point(rng, 2, 0.25), lattice_point(rng, 2, 0.25),
                             lattice_point(rng, 2, 0.25)};
    const Vec3d dir = lattice_point(rng, 2, 8.0);
    if (dir == Vec3d{}) continue;
    expect_exact(lattice_point(rng, 2, 0.25), dir, t, on_line);
  }
  EXPECT_GT(on_line, 500);
  EXPECT_LT(on_line, 40000);
}

/// As large as they may be, aimed at corners: the sums need all their bits.
TEST(IntegerEdges, AreThoseOfTheExactRuleUpToTheirLargest) {
  Rng rng(2);
  constexpr double kMost = 0x1p39 - 1;
  for (const double unit : {1.0, 0x1p-200, 0x1p180}) {
    int on_line = 0;
    for (int i = 0; i < 4000; ++i) {
      const TriangleVertices t{lattice_point(rng, kMost, unit), lattice_point(rng, kMost, unit),
                               lattice_point(rng, kMost, unit)};
      const Vec3d org = lattice_point(rng, kMost, unit);
      expect_exact(org, 0.5 * (t.a - org), t, on_line);
    }
    EXPECT_EQ(on_line, 0);
  }
}

TEST(IntegerEdges, AreRefusedWhereTheUnitIsTooCoarse) {
  const TriangleVertices t{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_TRUE(IntegerEdges::make({0x1p-38, 0, 0}, {1, 1, 1}, t));
  EXPECT_FALSE(IntegerEdges::make({0x1p-40, 0, 0}, {1, 1, 1}, t));
  EXPECT_FALSE(IntegerEdges::make({0, 0, 0}, {1, 0x1p-50, 1}, t));
  EXPECT_FALSE(IntegerEdges::make({0, 0, 0}, {1, 1, 1}, {{1, 0, 0}, {0, 1, 0}, {0, 0.1, 1}}));
  EXPECT_FALSE(IntegerEdges::make({0x1p-240, 0, 0}, {1, 1, 1}, {{1, 0, 0}, {0, 0x1p240, 0}, {}}));
}

}  // namespace
}  // namespace strahl
