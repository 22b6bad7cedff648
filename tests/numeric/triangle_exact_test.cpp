// The exact triangle against rational arithmetic: predicate, t, barycentrics, surface membership.
#include <cmath>
#include <tests/numeric/rational.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/geometry/edge_signs.h>
#include <strahl/geometry/triangle.h>

namespace strahl {
namespace {

using test::Rational;

struct Case {
  Vec3d org, dir;
  TriangleVertices tri;
};

/// Small integers: vertices, edges, planes and coincidences are hit all the time.
Vec3d lattice_point(Rng& rng, int reach) {
  const auto pick = [&] {
    return static_cast<double>(rng.below(2u * unsigned(reach) + 1)) - reach;
  };
  const double x = pick(), y = pick();
  return {x, y, pick()};
}

Vec3d random_point(Rng& rng, double scale) {
  const double x = rng.uniform(), y = rng.uniform();
  return {scale * (2 * x - 1), scale * (2 * y - 1), scale * (2 * rng.uniform() - 1)};
}

Case lattice_case(Rng& rng) {
  Case c;
  c.org = lattice_point(rng, 3);
  do c.dir = lattice_point(rng, 2);
  while (c.dir == Vec3d{});
  c.tri = {lattice_point(rng, 3), lattice_point(rng, 3), lattice_point(rng, 3)};
  return c;
}

/// Aimed at a corner or the middle of an edge, as nearly as doubles allow; far or near.
Case aimed_case(Rng& rng) {
  Case c;
  const double scale = std::ldexp(1.0, static_cast<int>(rng.below(80)) - 40);
  const double away = std::ldexp(1.0, static_cast<int>(rng.below(40)) - 8);
  const Vec3d shift = random_point(rng, scale * away);
  c.tri = {random_point(rng, scale) + shift, random_point(rng, scale) + shift,
           random_point(rng, scale) + shift};
  c.org = random_point(rng, scale * 2) + (rng.below(2) ? shift : Vec3d{});
  const Vec3d targets[] = {c.tri.a, 0.5 * (c.tri.a + c.tri.b), 0.25 * c.tri.a + 0.75 * c.tri.c,
                           (c.tri.a + c.tri.b + c.tri.c) / 3.0};
  c.dir = (targets[rng.below(4)] - c.org) * std::ldexp(1.0, static_cast<int>(rng.below(9)) - 4);
  if (rng.below(8) == 0) c.org = c.tri.b;
  return c;
}

/// float32 coordinates, thin triangles seen at a grazing angle.
Case sliver_case(Rng& rng) {
  Case c;
  const Vec3d a = random_point(rng, 1.0), along = random_point(rng, 1.0);
  const double thin = std::ldexp(1.0, -static_cast<int>(rng.below(40)));
  c.tri = {a, a + along, a + 0.4 * along + random_point(rng, thin)};
  for (Vec3d* v : {&c.tri.a, &c.tri.b, &c.tri.c}) *v = Vec3d(Vec3f(*v));
  c.org = random_point(rng, 3.0);
  c.dir = c.tri.a + 0.5 * (c.tri.b - c.tri.a) - c.org + random_point(rng, thin);
  return c;
}

/// From the middle of an edge of a sliver, within its plane, with the smallest coordinates allowed:
/// products of four of them underflow.
Case tiny_in_plane_case(Rng& rng) {
  const auto pick = [&] { return 0x1p-239 * (1 + 0x1p-30 * rng.below(1u << 30)); };
  const Vec3d b{pick(), pick(), 0};
  Case c{0.5 * b, {}, {{}, b, 2.0 * b + Vec3d{0, 0x1p-290, 0}}};
  do c.dir = lattice_point(rng, 2), c.dir.z = 0;
  while (c.dir == Vec3d{});
  return c;
}

/// Exactly through a corner of a triangle whose coordinates have few bits, or through or by a hair
/// beside the ends of an edge that lies along the ray as nearly as doubles allow.
Case corner_case(Rng& rng) {
  Case c;
  const double step = std::ldexp(1.0, -static_cast<int>(rng.below(26)));
  const auto grid_point = [&] { return step * lattice_point(rng, 1 << rng.below(12)); };
  c.tri = {grid_point(), grid_point(), grid_point()};
  c.org = grid_point();
  do c.dir = (c.tri.a - c.org) * std::ldexp(1.0, static_cast<int>(rng.below(9)) - 4);
  while (c.dir == Vec3d{} && (c.org = c.org + Vec3d::all(step), true));
  if (rng.below(3) > 0) return c;
  c.org = {};
  c.dir = Vec3d(Vec3f(random_point(rng, 1.0)));
  if (rng.below(2)) {
    c.tri = {rng.uniform(1.0, 9.0) * c.dir, random_point(rng, 5.0), rng.uniform(1.0, 9.0) * c.dir};
  } else {
    // tri.c - org is rounded by as much as tri.c lies beside the ray.
    c.org = -1024.0 * c.dir;
    c.tri = {-1020.0 * c.dir, random_point(rng, 5.0), random_point(rng, 0x1p-43)};
  }
  return c;
}

PreparedRay prepare(const Case& c) {
  RayFrame frame;
  frame.bounds = c.tri.bounds();
  return PreparedRay(Ray{c.org, c.dir}, frame);
}

/// |value - exact| <= 2^-40 |exact|.
bool is_close(double value, const Rational& exact) {
  const Rational error = abs(Rational(value) - exact);
  return error * Rational(0x1p40) <= abs(exact);
}

void check_case(const Case& c) {
  const int expected = test::rational_crossing(c.org, c.dir, c.tri);
  const std::optional<TriangleHit> hit = intersect(prepare(c), c.tri);
  ASSERT_EQ(hit.has_value(), expected != 0);
  if (!hit) return;
  ASSERT_EQ(hit->is_front, expected < 0);
  const test::RationalHit exact = test::rational_hit(c.org, c.dir, c.tri);
  if (exact.denominator == 0) {
    ASSERT_EQ(exact.numerator, 0);
    ASSERT_EQ(hit->t, 0.0);
  } else {
    ASSERT_TRUE(is_close(hit->t, exact.numerator / exact.denominator));
  }
  ASSERT_FALSE(std::signbit(hit->t) && hit->t == 0.0);
  const TriangleSurface s = surface_at(c.org, c.dir, c.tri);
  ASSERT_TRUE(is_close(s.u, exact.u));
  ASSERT_TRUE(is_close(s.v, exact.v));
  ASSERT_NEAR(length(s.normal), 1.0, 1e-15);
}

void check_many(Case (*make)(Rng&), int count, std::uint64_t seed) {
  Rng rng(seed);
  for (int i = 0; i < count; ++i) {
    SCOPED_TRACE(i);
    check_case(make(rng));
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(TriangleExact, AgreesWithRationalArithmeticOnIntegerCoincidences) {
  check_many(lattice_case, 60000, 1);
}
TEST(TriangleExact, AgreesWithRationalArithmeticOnTheSmallestCoordinates) {
  check_many(tiny_in_plane_case, 2000, 9);
}
TEST(TriangleExact, AgreesWithRationalArithmeticWhenAimedAtCornersAndEdges) {
  check_many(aimed_case, 20000, 2);
}
TEST(TriangleExact, AgreesWithRationalArithmeticThroughCorners) {
  check_many(corner_case, 20000, 10);
}
TEST(TriangleExact, AgreesWithRationalArithmeticOnGrazedSlivers) {
  check_many(sliver_case, 20000, 3);
}

TEST(TriangleExact, NeighboursNeitherBothClaimNorBothRefuseALine) {
  // Around every edge, exact signs of the two directions are opposite.
  Rng rng(4);
  for (int i = 0; i < 20000; ++i) {
    const Case c = rng.below(2) ? lattice_case(rng) : aimed_case(rng);
    if (c.tri.a == c.tri.b) continue;
    ASSERT_EQ(exact_edge_sign(c.org, c.dir, c.tri.a, c.tri.b),
              -exact_edge_sign(c.org, c.dir, c.tri.b, c.tri.a));
    ASSERT_NE(exact_edge_sign(c.org, c.dir, c.tri.a, c.tri.b), 0);
  }
}

TEST(TriangleExact, TheAnswerDoesNotDependOnTheFilter) {
  // A frame that makes every sign uncertain sends all of them through the exact evaluation.
  Rng rng(5);
  for (int i = 0; i < 20000; ++i) {
    const Case c = i % 2 ? aimed_case(rng) : sliver_case(rng);
    PreparedRay forced = prepare(c);
    forced.edge_error = Aabb::kInf;
    const auto a = intersect(prepare(c), c.tri), b = intersect(forced, c.tri);
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    ASSERT_EQ(a->t, b->t);
    ASSERT_EQ(a->is_front, b->is_front);
  }
}

TEST(TriangleExact, ZeroAreaIsFoundExactly) {
  Rng rng(6);
  for (int i = 0; i < 20000; ++i) {
    const Case c = i % 2 ? lattice_case(rng) : sliver_case(rng);
    const auto n = test::cross_of(test::minus(test::rational(c.tri.b), test::rational(c.tri.a)),
                                  test::minus(test::rational(c.tri.c), test::rational(c.tri.a)));
    const bool is_zero = n[0] == 0 && n[1] == 0 && n[2] == 0;
    ASSERT_EQ(find_defect(c.tri) != TriangleDefect::none, is_zero);
    if (is_zero) {
      ASSERT_FALSE(intersect(prepare(c), c.tri).has_value());
    }
  }
}

/// The point is a convex combination: solved exactly by the areas of the three parts.
bool rational_on_triangle(const Vec3d& point, const TriangleVertices& t) {
  using namespace test;
  const RationalVec p = rational(point), a = rational(t.a), b = rational(t.b), c = rational(t.c);
  const RationalVec n = cross_of(minus(b, a), minus(c, a));
  if (dot_of(minus(p, a), n) != 0) return false;
  return dot_of(cross_of(minus(b, a), minus(p, a)), n) >= 0 &&
         dot_of(cross_of(minus(c, b), minus(p, b)), n) >= 0 &&
         dot_of(cross_of(minus(a, c), minus(p, c)), n) >= 0;
}

TEST(TriangleExact, MembershipOfAPointIsExact) {
  Rng rng(7);
  int on = 0;
  for (int i = 0; i < 60000; ++i) {
    const Case c = lattice_case(rng);
    if (find_defect(c.tri) != TriangleDefect::none) continue;
    const bool expected = rational_on_triangle(c.org, c.tri);
    on += expected;
    ASSERT_EQ(is_on_triangle(c.org, c.tri), expected);
  }
  EXPECT_GT(on, 500);
}

TEST(TriangleClip, CoversEveryPointOfTheTriangleInsideTheBox) {
  Rng rng(8);
  for (int i = 0; i < 20000; ++i) {
    const Case c = i % 3 == 0 ? lattice_case(rng) : i % 3 == 1 ? aimed_case(rng) : sliver_case(rng);
    const Aabb own = c.tri.bounds();
    Aabb box;
    for (int k = 0; k < 2; ++k) {
      const Vec3d e = own.extent();
      box.extend(own.lo + Vec3d{e.x * rng.uniform(), e.y * rng.uniform(), e.z * rng.uniform()});
    }
    const Aabb part = clip(c.tri, box);
    for (int k = 0; k < 20; ++k) {
      double u = rng.uniform(), v = rng.uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3d p = c.tri.a + u * (c.tri.b - c.tri.a) + v * (c.tri.c - c.tri.a);
      // The sampled point itself is rounded: only points clearly inside the box bind.
      const Vec3d slack = Vec3d::all(1e-14 * std::max(norm_max(own.lo), norm_max(own.hi)));
      if (Aabb{box.lo + slack, box.hi - slack}.contains(p)) {
        ASSERT_TRUE((Aabb{part.lo - slack, part.hi + slack}.contains(p)));
      }
    }
    if (!part.is_empty()) {
      ASSERT_TRUE(box.contains(part) && own.contains(part));
    }
  }
}

TEST(TriangleClip, ATriangleThatOnlyTouchesTheBoxIsKept) {
  const TriangleVertices tri{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_FALSE(clip(tri, {{0.5, 0.5, -1}, {2, 2, 1}}).is_empty());
  EXPECT_FALSE(clip(tri, {{1, 0, 0}, {2, 2, 1}}).is_empty());
  EXPECT_FALSE(clip(tri, {{-1, -1, 0}, {2, 2, 1}}).is_empty());
  EXPECT_TRUE(clip(tri, {{0.6, 0.6, -1}, {2, 2, 1}}).is_empty());
}

}  // namespace
}  // namespace strahl
