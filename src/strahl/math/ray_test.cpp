#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/math/ray.h>

namespace strahl {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Ray good() { return {{1, 2, 3}, {0, 0, -1}}; }

TEST(Ray, ValidityFollowsTheContract) {
  EXPECT_TRUE(is_valid(good()));
  for (const double bad : {kNan, Aabb::kInf, -Aabb::kInf, 0x1p241, 0x1p-241}) {
    Ray r = good();
    r.org.y = bad;
    EXPECT_FALSE(is_valid(r)) << bad;
    r = good();
    r.dir.x = bad;
    EXPECT_FALSE(is_valid(r)) << bad;
  }
  Ray r = good();
  r.dir = {0.0, -0.0, 0.0};
  EXPECT_FALSE(is_valid(r));
  for (const double t : {-1e-300, kNan, Aabb::kInf}) {
    r = good();
    r.t_min = t;
    EXPECT_FALSE(is_valid(r)) << t;
  }
  for (const double t : {-1.0, kNan}) {
    r = good();
    r.t_max = t;
    EXPECT_FALSE(is_valid(r)) << t;
  }
  r = good();
  r.t_min = 2, r.t_max = 1;
  EXPECT_TRUE(is_valid(r));
  r.org.x = std::numeric_limits<float>::denorm_min();
  EXPECT_TRUE(is_valid(r));
}

/// Points of the ray inside the box must lie in the interval found.
TEST(ClipToBox, NeverLosesAPointOfTheRayInTheBox) {
  Rng rng(1);
  int inside = 0;
  for (int i = 0; i < 200000; ++i) {
    const double scale = std::ldexp(1.0, static_cast<int>(rng.below(60)) - 30);
    const auto coordinate = [&] { return rng.below(4) ? rng.uniform(-1, 1) * scale : 0.5 * scale; };
    Vec3d p, q, org, dir;
    for (int a = 0; a < 3; ++a) {
      p[a] = coordinate(), q[a] = coordinate(), org[a] = coordinate();
      dir[a] = rng.below(3) ? rng.uniform(-1, 1) : 0.0;
    }
    if (dir == Vec3d{}) continue;
    const Aabb box{min(p, q), max(p, q)};
    const PreparedRay ray({org, dir}, {box, 0, 0});
    const Interval span = clip_to_box(ray, box.lo, box.hi, {ray.t_enter, ray.t_exit});
    // t of a corner on every axis where the ray moves: the sharpest points there are.
    for (int a = 0; a < 3; ++a) {
      if (dir[a] == 0.0) continue;
      const double t = (box.lo[a] - org[a]) / dir[a];
      if (!(t >= 0.0)) continue;
      Vec3d x = org + t * dir;
      x[a] = box.lo[a];
      const double slack = 1e-12 * scale * (1 + t);
      if (!Aabb{box.lo + Vec3d::all(slack), box.hi - Vec3d::all(slack)}.contains(x) &&
          !(x[a] == box.lo[a] && box.lo[(a + 1) % 3] + slack <= x[(a + 1) % 3] &&
            x[(a + 1) % 3] <= box.hi[(a + 1) % 3] - slack &&
            box.lo[(a + 2) % 3] + slack <= x[(a + 2) % 3] &&
            x[(a + 2) % 3] <= box.hi[(a + 2) % 3] - slack))
        continue;
      ++inside;
      ASSERT_LE(span.t_enter, t * (1 + 1e-15));
      ASSERT_GE(span.t_exit, t * (1 - 1e-15));
    }
  }
  EXPECT_GT(inside, 1000);
}

TEST(ClipToBox, ARayInAFaceIsInsideAndOneBesideItIsNot) {
  const Aabb box{{0, 0, 0}, {1, 1, 1}};
  const auto crosses = [&](const Vec3d& org) {
    const PreparedRay ray({org, {0, 0, 1}}, {box, 0, 0});
    const Interval s = clip_to_box(ray, box.lo, box.hi, {ray.t_enter, ray.t_exit});
    return s.t_enter <= s.t_exit;
  };
  EXPECT_TRUE(crosses({0, 0.5, -1}));
  EXPECT_TRUE(crosses({1, 1, -1}));
  EXPECT_FALSE(crosses({std::nextafter(1.0, 2.0), 0.5, -1}));
  EXPECT_FALSE(crosses({-1e-300, 0.5, -1}));
}

TEST(ClipToSide, SixSidesAreABox) {
  Rng rng(6);
  const auto small = [&] { return static_cast<double>(rng.below(5)) - 2.0; };
  for (int i = 0; i < 2000; ++i) {
    const Ray given{{small(), small(), small()}, {small(), small(), small()}};
    const Aabb box{{-1, -1, 0}, {1, 0.7, 0}};
    const PreparedRay ray(given, {box, 0, 0});
    Interval by_sides{ray.t_enter, ray.t_exit};
    for (int axis = 0; axis < 3; ++axis) {
      by_sides = clip_to_side(ray, axis, true, box.lo[axis], by_sides);
      by_sides = clip_to_side(ray, axis, false, box.hi[axis], by_sides);
    }
    const Interval whole = clip_to_box(ray, box.lo, box.hi, {ray.t_enter, ray.t_exit});
    ASSERT_EQ(by_sides.t_enter, whole.t_enter);
    ASSERT_EQ(by_sides.t_exit, whole.t_exit);
  }
}

TEST(PreparedRay, WideningMovesNearPlanesEarlierAndFarPlanesLater) {
  const Aabb box{{0, 0, 0}, {1, 1, 1}};
  for (const double sign : {1.0, -1.0}) {
    const Ray ray{{0.5 - 4 * sign, 1.5, 0.5}, {sign, 0, 0}};
    const auto span = [&](double widen) {
      const PreparedRay p(ray, {box, widen, 0});
      return clip_to_box(p, box.lo, box.hi, {p.t_enter, p.t_exit});
    };
    EXPECT_GT(span(0.0).t_enter, span(0.0).t_exit);
    EXPECT_LE(span(0.75).t_enter, 3.5 - 0.75);
    EXPECT_GE(span(0.75).t_exit, 4.5 + 0.75);
  }
}

}  // namespace
}  // namespace strahl
