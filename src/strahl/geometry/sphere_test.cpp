#include <algorithm>
#include <cmath>
#include <limits>
#include <tests/support/curved_cases.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/geometry/sphere.h>

namespace strahl {
namespace {

using test::Wide;
using test::WideRoot;
using test::WideVec;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Sphere kUnit{{0, 0, 0}, 1};

CurvedHits tied(const Sphere& s, const Ray& ray) {
  return tie_to_box(intersect(s, ray.org, ray.dir), ray.org, ray.dir, bounds(s));
}

/// Roots of the infinite line in high precision; `band` receives (r^2 - p.p) / r^2.
std::vector<WideRoot> true_roots(const Sphere& s, const Ray& ray, double& band) {
  const WideVec f = test::wide(s.center) - test::wide(ray.org), d = test::wide(ray.dir);
  const Wide r = s.radius, dd = dot(d, d), middle = dot(f, d) / dd;
  const WideVec p = f - middle * d;
  const Wide squared = r * r - dot(p, p);
  band = test::narrow(squared / (r * r));
  if (squared <= 0) return {};
  const Wide half = sqrt(squared / dd);
  return {{middle - half, true}, {middle + half, false}};
}

TEST(SphereIntersect, HitsInAndOutAlongADiameter) {
  const CurvedHits hits = intersect({{1, 2, 3}, 2}, {1, 2, -7}, {0, 0, 2});
  ASSERT_EQ(hits.count, 2);
  EXPECT_EQ(hits.hit[0].t, 4.0);
  EXPECT_TRUE(hits.hit[0].is_front);
  EXPECT_EQ(hits.hit[1].t, 6.0);
  EXPECT_FALSE(hits.hit[1].is_front);
}

TEST(SphereIntersect, GivesRootsBehindTheOriginToo) {
  const CurvedHits inside = intersect(kUnit, {0, 0, 0}, {0, 0.5, 0});
  ASSERT_EQ(inside.count, 2);
  EXPECT_EQ(inside.hit[0].t, -2.0);
  EXPECT_EQ(inside.hit[1].t, 2.0);
  const CurvedHits behind = intersect(kUnit, {5, 0, 0}, {1, 0, 0});
  ASSERT_EQ(behind.count, 2);
  EXPECT_EQ(behind.hit[1].t, -4.0);
}

TEST(SphereIntersect, SolvesATriangleOfIntegers) {
  const CurvedHits hits = intersect({{0, 0, 0}, 5}, {-10, 3, 0}, {1, 0, 0});
  ASSERT_EQ(hits.count, 2);
  EXPECT_EQ(hits.hit[0].t, 6.0);
  EXPECT_EQ(hits.hit[1].t, 14.0);
}

TEST(SphereIntersect, DoesNotCountATangent) {
  EXPECT_EQ(intersect(kUnit, {-5, 1, 0}, {1, 0, 0}).count, 0);
  EXPECT_EQ(intersect(kUnit, {-5, 0, -1}, {4, 0, 0}).count, 0);
  EXPECT_EQ(intersect({{0, 0, 0}, 5}, {3 - 4e6, 4 + 3e6, 0}, {4, -3, 0}).count, 0);
  for (const double slope : {3.0, 7.0, 0.1})
    EXPECT_EQ(tied(kUnit, {{-5, 1, 0}, {slope, 0, 0}}).count, 0) << slope;
}

TEST(SphereIntersect, SeparatesOneUlpAroundATangent) {
  EXPECT_EQ(intersect(kUnit, {-5, std::nextafter(1.0, 0.0), 0}, {1, 0, 0}).count, 2);
  EXPECT_EQ(intersect(kUnit, {-5, std::nextafter(1.0, 2.0), 0}, {1, 0, 0}).count, 0);
  EXPECT_EQ(intersect(kUnit, {-5e8, std::nextafter(1.0, 0.0), 0}, {1, 0, 0}).count, 2);
  EXPECT_EQ(intersect(kUnit, {-5e8, std::nextafter(1.0, 2.0), 0}, {1, 0, 0}).count, 0);
}

TEST(SphereIntersect, HitsFromTheSurfaceItself) {
  const CurvedHits hits = tied(kUnit, {{-1, 0, 0}, {1, 0, 0}});
  ASSERT_EQ(hits.count, 2);
  EXPECT_EQ(hits.hit[0].t, 0.0);
  EXPECT_EQ(hits.hit[1].t, 2.0);
}

TEST(SphereIntersect, NeverHitsAnInvalidSphere) {
  const Sphere invalid[] = {{{0, 0, 0}, 0.0},     {{0, 0, 0}, -1.0},       {{0, 0, 0}, kNan},
                            {{0, 0, 0}, kInf},    {{0, kNan, 0}, 1.0},     {{kInf, 0, 0}, 1.0},
                            {{0, 0, 0}, 0x1p241}, {{0, 0, 0x1p-241}, 1.0}, {{0, 0, 0}, 0x1p-241}};
  for (const Sphere& s : invalid) {
    EXPECT_EQ(intersect(s, {-5, 0, 0}, {1, 0, 0}).count, 0) << s.radius;
    EXPECT_TRUE(bounds(s).is_empty()) << s.radius;
    EXPECT_TRUE(clip(s, {{-9, -9, -9}, {9, 9, 9}}).is_empty()) << s.radius;
  }
}

struct Case {
  Sphere sphere;
  Ray ray;
};

/// A ray from 10^distance radii away through or past a sphere anywhere, often near its rim.
Case random_case(Rng& rng, double distance) {
  Case c;
  const double radius = test::random_magnitude(rng, -3, 3);
  c.sphere = {test::random_vector(rng, test::random_magnitude(rng, -1, 3) * radius), radius};
  const Vec3d aside = unit(test::random_vector(rng));
  const double nearness = test::random_magnitude(rng, -12, 0);
  const double far = rng.below(2) == 0 ? 1.0 - nearness : 1.0 + nearness;
  const Vec3d target =
      c.sphere.center + (rng.below(2) == 0 ? far * radius : radius * rng.uniform()) * aside;
  c.ray = test::random_ray_at(rng, target, std::pow(10.0, distance) * radius);
  if (rng.below(2) == 0) {  // at right angles to `aside`, so that it passes at that distance
    const Vec3d dir = cross(aside, test::random_vector(rng));
    c.ray.dir = length(c.ray.dir) * unit(dir);
    c.ray.org = target - std::pow(10.0, distance) * radius * unit(dir);
  }
  return c;
}

TEST(SphereIntersect, AgreesWithHighPrecisionFromAnyDistance) {
  Rng rng(4);
  int compared = 0, grazing = 0;
  for (int i = 0; i < 40000; ++i) {
    const Case c = random_case(rng, rng.uniform(-3, 9));
    double band;
    const std::vector<WideRoot> truth = true_roots(c.sphere, c.ray, band);
    if (std::abs(band) < 1e-9) continue;
    ++compared;
    grazing += std::abs(band) < 1e-6;
    const double unit_t = c.sphere.radius / length(c.ray.dir);
    ASSERT_TRUE(test::agree(intersect(c.sphere, c.ray.org, c.ray.dir), truth, unit_t, 1e-15))
        << "case " << i << " band " << band;
    ASSERT_TRUE(test::agree(tied(c.sphere, c.ray), truth, unit_t, 1e-15)) << "case " << i;
  }
  EXPECT_GT(compared, 25000);
  EXPECT_GT(grazing, 2000);
}

TEST(SphereIntersect, IsExactlyScaledByPowersOfTwo) {
  Rng rng(5);
  for (int i = 0; i < 20000; ++i) {
    const Case c = random_case(rng, rng.uniform(-3, 9));
    const CurvedHits hits = intersect(c.sphere, c.ray.org, c.ray.dir);
    const double size = std::ldexp(1.0, static_cast<int>(rng.below(361)) - 180);
    const double speed = std::ldexp(1.0, static_cast<int>(rng.below(361)) - 180);
    const Sphere scaled{size * c.sphere.center, size * c.sphere.radius};
    const CurvedHits got = intersect(scaled, size * c.ray.org, speed * c.ray.dir);
    ASSERT_EQ(got.count, hits.count);
    for (std::size_t k = 0; k < static_cast<std::size_t>(hits.count); ++k)
      ASSERT_EQ(got.hit[k].t, hits.hit[k].t * (size / speed)) << "case " << i;
  }
}

Vec3d mirrored(Vec3d v, int axis) {
  v[axis] = -v[axis];
  return v;
}

TEST(SphereIntersect, IsTheSameInAMirrorAndBackwards) {
  Rng rng(6);
  for (int i = 0; i < 20000; ++i) {
    const Case c = random_case(rng, rng.uniform(-3, 9));
    const CurvedHits hits = intersect(c.sphere, c.ray.org, c.ray.dir);
    const int axis = i % 3;
    const CurvedHits mirror = intersect({mirrored(c.sphere.center, axis), c.sphere.radius},
                                        mirrored(c.ray.org, axis), mirrored(c.ray.dir, axis));
    const CurvedHits back = intersect(c.sphere, c.ray.org, -c.ray.dir);
    ASSERT_EQ(mirror.count, hits.count);
    ASSERT_EQ(back.count, hits.count);
    if (hits.count == 0) continue;
    ASSERT_EQ(mirror.hit[0].t, hits.hit[0].t);
    ASSERT_EQ(mirror.hit[1].t, hits.hit[1].t);
    ASSERT_EQ(back.hit[0].t, -hits.hit[1].t);
    ASSERT_EQ(back.hit[1].t, -hits.hit[0].t);
  }
}

TEST(SphereIntersect, SurvivesTheLimitsOfTheRange) {
  for (const double r : {0x1p-240, 1.0, 0x1p240})
    for (const double far : {0x1p-240, 1.0, 0x1p240})
      for (const double speed : {0x1p-240, 1.0, 0x1p240}) {
        const CurvedHits hits = tied({{0, 0, 0}, r}, {{-far, 0, 0}, {speed, 0, 0}});
        for (std::size_t k = 0; k < static_cast<std::size_t>(hits.count); ++k) {
          const double x = -far + hits.hit[k].t * speed;
          EXPECT_NEAR(std::abs(x), r, 1e-15 * std::max(r, far)) << r << ' ' << far << ' ' << speed;
        }
        EXPECT_EQ(hits.count, r < 1e-16 * far ? 0 : 2) << r << ' ' << far << ' ' << speed;
      }
}

TEST(SphereIntersect, LiesInTheFilterIntervalOfEveryEnclosingBox) {
  Rng rng(7);
  int kept = 0;
  for (int i = 0; i < 200000; ++i) {
    const Case c = random_case(rng, rng.uniform(-3, 30));
    const CurvedHits hits = tied(c.sphere, c.ray);
    const Aabb outer = test::random_enclosing_box(rng, bounds(c.sphere));
    for (std::size_t k = 0; k < static_cast<std::size_t>(hits.count); ++k) {
      const double t = hits.hit[k].t;
      ASSERT_TRUE(test::filter_keeps(c.ray, outer, t, t)) << "case " << i;
      ++kept;
    }
  }
  EXPECT_GT(kept, 50000);
}

TEST(SphereBounds, AreExactOrOneUlpOutward) {
  EXPECT_EQ(bounds({{1, 2, 3}, 2}), (Aabb{{-1, 0, 1}, {3, 4, 5}}));
  Rng rng(8);
  for (int i = 0; i < 20000; ++i) {
    const Sphere s = random_case(rng, 0).sphere;
    const Aabb box = bounds(s);
    for (int axis = 0; axis < 3; ++axis) {
      const Wide lo = Wide(s.center[axis]) - Wide(s.radius);
      const Wide hi = Wide(s.center[axis]) + Wide(s.radius);
      ASSERT_TRUE(Wide(box.lo[axis]) <= lo && Wide(box.hi[axis]) >= hi);
      ASSERT_TRUE(Wide(std::nextafter(box.lo[axis], kInf)) > lo);
      ASSERT_TRUE(Wide(std::nextafter(box.hi[axis], -kInf)) < hi);
    }
  }
}

TEST(SphereClip, IsTheBoundsCutByTheBox) {
  const Aabb box{{0.5, -9, 0}, {9, 0.25, 0.75}};
  EXPECT_EQ(clip(kUnit, box), (Aabb{{0.5, -1, 0}, {1, 0.25, 0.75}}));
  EXPECT_TRUE(clip(kUnit, {{2, 2, 2}, {3, 3, 3}}).is_empty());
}

TEST(SphereNormal, PointsOutwardAgainstTheDirectionInFront) {
  EXPECT_EQ(normal_at(kUnit, {-5, 0, 0}, {2, 0, 0}, 2.0), (Vec3d{-1, 0, 0}));
  EXPECT_EQ(normal_at(kUnit, {-5, 0, 0}, {2, 0, 0}, 3.0), (Vec3d{1, 0, 0}));
  EXPECT_EQ(normal_at(kUnit, {-5, 0, 0}, {2, 0, 0}, 2.5), (Vec3d{-1, 0, 0}));
  Rng rng(9);
  for (int i = 0; i < 20000; ++i) {
    const Case c = random_case(rng, rng.uniform(-3, 6));
    double band;
    const std::vector<WideRoot> truth = true_roots(c.sphere, c.ray, band);
    if (band < 1e-9) continue;
    const CurvedHits hits = intersect(c.sphere, c.ray.org, c.ray.dir);
    for (std::size_t k = 0; k < 2; ++k) {
      const double t = hits.hit[k].t;
      const Vec3d n = normal_at(c.sphere, c.ray.org, c.ray.dir, t);
      const WideVec p =
          test::wide(c.ray.org) + truth[k].t * test::wide(c.ray.dir) - test::wide(c.sphere.center);
      const double moved = std::abs(t) * length(c.ray.dir) / c.sphere.radius;
      for (int axis = 0; axis < 3; ++axis)
        ASSERT_NEAR(n[axis], test::narrow(p[axis] / Wide(c.sphere.radius)), 4e-16 * (3 + moved));
      ASSERT_NEAR(length(n), 1.0, 4e-16);
    }
  }
}

}  // namespace
}  // namespace strahl
