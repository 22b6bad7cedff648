#include <algorithm>
#include <cmath>
#include <limits>
#include <tests/support/curved_cases.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/geometry/cone.h>

namespace strahl {
namespace {

using test::Wide;
using test::WideRoot;
using test::WideVec;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Cone kCylinder{{0, 0, 0}, 1, {0, 0, 2}, 1};
const Cone kFullCone{{0, 0, 0}, 1, {0, 0, 1}, 0};
const Cone kTruncated{{0, 0, 0}, 1, {0, 0, 4}, 3};

CurvedHits tied(const Cone& c, const Ray& ray) {
  return tie_to_box(intersect(c, ray.org, ray.dir), ray.org, ray.dir, bounds(c));
}
int count(const Cone& c, const Vec3d& org, const Vec3d& dir) {
  const int n = intersect(c, org, dir).count;
  EXPECT_EQ(tied(c, {org, dir}).count, n);
  return n;
}
double size_of(const Cone& c) {
  return std::max({c.base_radius, c.apex_radius, length(c.apex - c.base)});
}

/// The roots in high precision, and how clear they are.
struct Truth {
  std::vector<WideRoot> roots;
  double band = 0.0;  ///< (rho n.dir / (size |dir|))^2 cos^2 at the roots; negative: none
  double rim_gap =
      kInf;  ///< smallest distance of a root from a rim along the axis, over the height
};

Truth true_roots(const Cone& cone, const Ray& ray) {
  const WideVec base = test::wide(cone.base), w = test::wide(cone.apex) - base;
  const WideVec d = test::wide(ray.dir), f = test::wide(ray.org) - base;
  const Wide ww = dot(w, w), dd = dot(d, d), widening = Wide(cone.apex_radius) - cone.base_radius;
  const Wide start = -dot(f - Wide(0.5) * w, d) / dd;
  const WideVec p = f + start * d;
  // |X|^2 - (X.w)^2 / ww - (base_radius + widening (X.w) / ww)^2 along X = p + u d.
  const Wide pz = dot(p, w) / ww, dz = dot(d, w) / ww;
  const Wide e = cone.base_radius + widening * pz, g = widening * dz;
  const Wide A = dd - dz * dz * ww - g * g, B = dot(p, d) - pz * dz * ww - e * g;
  const Wide C = dot(p, p) - pz * pz * ww - e * e, disc = B * B - A * C;
  const Wide cos2 = ww / (ww + widening * widening), size = size_of(cone);
  Truth truth;
  truth.band = test::narrow(disc * cos2 * cos2 / (dd * size * size));
  if (disc <= 0 || A == 0) return truth;
  for (const bool is_front : {true, false}) {
    const Wide u = ((is_front ? -sqrt(disc) : sqrt(disc)) - B) / A, z = pz + u * dz;
    truth.rim_gap =
        std::min({truth.rim_gap, std::abs(test::narrow(z)), std::abs(test::narrow(1 - z))});
    if (z >= 0 && z <= 1) truth.roots.push_back({start + u, is_front});
  }
  if (truth.roots.size() == 2 && truth.roots[1].t < truth.roots[0].t)
    std::swap(truth.roots[0], truth.roots[1]);
  return truth;
}

TEST(ConeIntersect, HitsACylinderInAndOut) {
  const CurvedHits hits = intersect(kCylinder, {-5, 0, 1}, {2, 0, 0});
  ASSERT_EQ(hits.count, 2);
  EXPECT_EQ(hits.hit[0].t, 2.0);
  EXPECT_TRUE(hits.hit[0].is_front);
  EXPECT_EQ(hits.hit[1].t, 3.0);
  EXPECT_FALSE(hits.hit[1].is_front);
}

TEST(ConeIntersect, HasNoEndCaps) {
  EXPECT_EQ(count(kCylinder, {0.5, 0, -3}, {0, 0, 1}), 0);
  EXPECT_EQ(count(kCylinder, {0.5, 0, 3}, {0.5, 0, -1}), 1);  // in at the open top, out of the side
  EXPECT_EQ(count(kFullCone, {0.5, 0, -1}, {0, 0, 1}), 1);    // in at the open base
  EXPECT_EQ(count(kTruncated, {0.5, 0, -1}, {0, 0, 1}), 0);   // in at the base, out at the top
  EXPECT_EQ(count(kTruncated, {2, 0, -1}, {0, 0, 1}), 1);     // in from outside, out at the top
}

TEST(ConeIntersect, CountsTheRimsAndNothingBeyond) {
  for (const Cone& c : {kCylinder, kTruncated})
    for (const double z : {c.base.z, c.apex.z}) {
      EXPECT_EQ(count(c, {-5, 0.25, z}, {1, 0, 0}), 2) << z;
      const double beyond = z == 0.0 ? -0x1p-240 : std::nextafter(z, 9.0);
      EXPECT_EQ(count(c, {-5, 0.25, beyond}, {1, 0, 0}), 0) << z;
    }
}

TEST(ConeIntersect, FindsBothSidesOfAFullCone) {
  const CurvedHits hits = intersect(kFullCone, {-5, 0, 0.5}, {1, 0, 0});
  ASSERT_EQ(hits.count, 2);
  EXPECT_NEAR(hits.hit[0].t, 4.5, 1e-15);
  EXPECT_NEAR(hits.hit[1].t, 5.5, 1e-15);
  EXPECT_TRUE(hits.hit[0].is_front);
  EXPECT_FALSE(hits.hit[1].is_front);
}

TEST(ConeIntersect, DropsTheMirrorNappe) {
  EXPECT_EQ(count(kFullCone, {-5, 0, 1.5}, {1, 0, 0}), 0);
  const CurvedHits hits = intersect(kFullCone, {0.25, 0, 9}, {0, 0, -1});  // through both nappes
  ASSERT_EQ(hits.count, 1);
  EXPECT_NEAR(hits.hit[0].t, 8.25, 1e-14);
  EXPECT_TRUE(hits.hit[0].is_front);
}

TEST(ConeIntersect, IsTheSameConeWithItsEndsExchanged) {
  const Cone turned{kTruncated.apex, 3, kTruncated.base, 1};
  const CurvedHits a = intersect(kTruncated, {-9, 0.5, 1}, {1, 0, 0.25});
  const CurvedHits b = intersect(turned, {-9, 0.5, 1}, {1, 0, 0.25});
  ASSERT_EQ(a.count, 2);
  ASSERT_EQ(b.count, 2);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(a.hit[k].t, b.hit[k].t, 1e-14);
    EXPECT_EQ(a.hit[k].is_front, b.hit[k].is_front);
  }
}

TEST(ConeIntersect, DoesNotCountATangent) {
  EXPECT_EQ(count(kCylinder, {-5, 1, 1}, {1, 0, 0}), 0);
  EXPECT_EQ(count(kCylinder, {-5, -1, 1}, {3, 0, 0.125}), 0);
  EXPECT_EQ(count(kCylinder, {-5, std::nextafter(1.0, 0.0), 1}, {1, 0, 0}), 2);
  EXPECT_EQ(count(kCylinder, {-5, std::nextafter(1.0, 2.0), 1}, {1, 0, 0}), 0);
}

TEST(ConeIntersect, NeverHitsACylinderAlongItsAxis) {
  const Vec3d axis{0.1, 0.2, 0.3};
  const Cone oblique{{0, 0, 0}, 0.5, axis, 0.5};
  Rng rng(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3d org = test::random_vector(rng, 0.6);
    EXPECT_EQ(intersect(oblique, org, axis).count, 0);
    EXPECT_EQ(intersect(oblique, org, -0.5 * axis).count, 0);
    const Vec3d on_surface = 0.5 * unit(cross(axis, org));
    EXPECT_EQ(intersect(oblique, on_surface, axis).count, 0);
  }
  for (const double x : {0.0, 0.5, 1.0, 2.0})
    EXPECT_EQ(count(kCylinder, {x, 0, -3}, {0, 0, 0.7}), 0);
}

TEST(ConeIntersect, HasOneRootParallelToAGenerator) {
  const CurvedHits hits = intersect(kFullCone, {0, 0.25, 0.5}, {1, 0, -1});
  ASSERT_EQ(hits.count, 1);
  EXPECT_NEAR(hits.hit[0].t, -0.1875, 1e-15);
  EXPECT_TRUE(hits.hit[0].is_front);
  const CurvedHits back = intersect(kFullCone, {0, 0.25, 0.5}, {-1, 0, 1});
  ASSERT_EQ(back.count, 1);
  EXPECT_NEAR(back.hit[0].t, 0.1875, 1e-15);
  EXPECT_FALSE(back.hit[0].is_front);
}

TEST(ConeIntersect, DoesNotCountALineInTheSurface) {
  EXPECT_EQ(count(kFullCone, {1, 0, 0}, {-1, 0, 1}), 0);
  EXPECT_EQ(count(kFullCone, {0, -3, -2}, {0, 1, 1}), 0);
  EXPECT_EQ(count(kCylinder, {1, 0, -3}, {0, 0, 1}), 0);
}

TEST(ConeIntersect, NeverHitsAnInvalidCone) {
  const Vec3d o{0, 0, 0}, z{0, 0, 1};
  const Cone invalid[] = {{o, 1, o, 1},
                          {o, 0, z, 0},
                          {o, -1, z, 1},
                          {o, 1, z, -1},
                          {o, kNan, z, 1},
                          {o, 1, z, kInf},
                          {{0, kNan, 0}, 1, z, 1},
                          {o, 1, {0, 0, kInf}, 1},
                          {o, 0x1p241, z, 1},
                          {o, 1, z, 0x1p-241},
                          {{0x1p-241, 0, 0}, 1, z, 1}};
  for (const Cone& c : invalid) {
    EXPECT_EQ(intersect(c, {-5, 0, 0.5}, {1, 0, 0}).count, 0);
    EXPECT_TRUE(bounds(c).is_empty());
    EXPECT_TRUE(clip(c, {{-9, -9, -9}, {9, 9, 9}}).is_empty());
  }
}

struct Case {
  Cone cone;
  Ray ray;
};

/// A cone of any kind, aspect 0.01..100, from 10^distance sizes away; some rays nearly or exactly
/// parallel to the axis or to a generator line.
Case random_case(Rng& rng, double distance) {
  Case c;
  const double height = test::random_magnitude(rng, -3, 3);
  const double radius = height * test::random_magnitude(rng, -2, 2);
  Vec3d axis = unit(test::random_vector(rng));
  if (rng.below(4) == 0) axis = {0, rng.below(2) == 0 ? 1.0 : -1.0, 0};
  const double other[] = {radius, 0.0, radius * rng.uniform(), radius * (1 + 1e-6 * rng.uniform())};
  c.cone.base = test::random_vector(rng, height * test::random_magnitude(rng, -1, 3));
  c.cone.apex = c.cone.base + height * axis;
  c.cone.base_radius = radius, c.cone.apex_radius = other[rng.below(4)];
  if (rng.below(2) == 0) std::swap(c.cone.base_radius, c.cone.apex_radius);

  const Vec3d side = unit(cross(axis, test::random_vector(rng)));
  const double at = rng.uniform(-0.2, 1.2);
  const double rho = c.cone.base_radius + at * (c.cone.apex_radius - c.cone.base_radius);
  const Vec3d target = c.cone.base + (at * height) * axis + rng.uniform(-1.2, 1.2) * rho * side;
  const double away = size_of(c.cone) * std::pow(10.0, distance);
  c.ray = test::random_ray_at(rng, target, away);
  const std::uint32_t kind = rng.below(6);
  if (kind < 2) {
    const double widening = kind == 0 ? 0.0 : c.cone.apex_radius - c.cone.base_radius;
    const double off = rng.below(3) == 0 ? 0.0 : test::random_magnitude(rng, -17, -1);
    const Vec3d dir = unit(height * axis + widening * side) + off * test::random_vector(rng);
    c.ray.dir = length(c.ray.dir) * dir;
    c.ray.org = target - away * dir + (rng.below(2) * 0.5 * radius) * unit(cross(side, dir));
  }
  return c;
}

TEST(ConeIntersect, AgreesWithHighPrecisionFromAnyDistance) {
  Rng rng(2);
  int compared = 0, hit = 0, grazing = 0;
  for (int i = 0; i < 40000; ++i) {
    const Case c = random_case(rng, rng.uniform(-3, 9));
    const Truth truth = true_roots(c.cone, c.ray);
    if (std::abs(truth.band) < 1e-10 || truth.rim_gap < 1e-8) continue;
    ++compared;
    hit += !truth.roots.empty();
    grazing += std::abs(truth.band) < 1e-6;
    const double unit_t = size_of(c.cone) / length(c.ray.dir);
    const double tolerance = 2e-15 / std::sqrt(std::min(1.0, std::abs(truth.band)));
    const CurvedHits hits = intersect(c.cone, c.ray.org, c.ray.dir);
    ASSERT_TRUE(test::agree(hits, truth.roots, unit_t, tolerance))
        << "case " << i << " band " << truth.band << " rim " << truth.rim_gap << " hits "
        << hits.count << " truth " << truth.roots.size();
    ASSERT_TRUE(test::agree(tied(c.cone, c.ray), truth.roots, unit_t, tolerance)) << "case " << i;
  }
  EXPECT_GT(compared, 30000);
  EXPECT_GT(hit, 10000);
  EXPECT_GT(grazing, 500);
}

TEST(ConeIntersect, IsExactlyScaledByPowersOfTwo) {
  Rng rng(3);
  for (int i = 0; i < 20000; ++i) {
    const Case c = random_case(rng, rng.uniform(-3, 9));
    const CurvedHits hits = intersect(c.cone, c.ray.org, c.ray.dir);
    const double size = std::ldexp(1.0, static_cast<int>(rng.below(361)) - 180);
    const double speed = std::ldexp(1.0, static_cast<int>(rng.below(241)) - 120);
    const Cone scaled{size * c.cone.base, size * c.cone.base_radius, size * c.cone.apex,
                      size * c.cone.apex_radius};
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

TEST(ConeIntersect, IsTheSameInAMirror) {
  Rng rng(4);
  for (int i = 0; i < 20000; ++i) {
    const Case c = random_case(rng, rng.uniform(-3, 9));
    const int axis = i % 3;
    const Cone mirror{mirrored(c.cone.base, axis), c.cone.base_radius, mirrored(c.cone.apex, axis),
                      c.cone.apex_radius};
    const CurvedHits hits = intersect(c.cone, c.ray.org, c.ray.dir);
    const CurvedHits got = intersect(mirror, mirrored(c.ray.org, axis), mirrored(c.ray.dir, axis));
    ASSERT_EQ(got.count, hits.count);
    for (std::size_t k = 0; k < static_cast<std::size_t>(hits.count); ++k) {
      ASSERT_EQ(got.hit[k].t, hits.hit[k].t);
      ASSERT_EQ(got.hit[k].is_front, hits.hit[k].is_front);
    }
  }
}

TEST(ConeIntersect, SurvivesTheLimitsOfTheRange) {
  const double scales[] = {0x1p-240, 1.0, 0x1p240};
  for (const double r : scales)
    for (const double h : scales)
      for (const double far : scales)
        for (const double speed : scales) {
          const Cone c{{0, 0, 0}, r, {0, 0, h}, r};
          const CurvedHits hits = tied(c, {{-far, 0, h}, {speed, 0, 0}});
          EXPECT_EQ(hits.count, r < 1e-16 * far ? 0 : 2) << r << ' ' << h << ' ' << far;
          for (std::size_t k = 0; k < static_cast<std::size_t>(hits.count); ++k)
            EXPECT_NEAR(std::abs(-far + hits.hit[k].t * speed), r, 1e-15 * std::max(r, far));
          for (const double apex_radius : {0.0, 0x1p-240, 0x1p240}) {
            const CurvedHits any = tied({{0, 0, 0}, r, {0, 0, h}, apex_radius},
                                        {{-far, far, h}, {speed, 0, 0x1p-240}});
            for (std::size_t k = 0; k < static_cast<std::size_t>(any.count); ++k)
              EXPECT_TRUE(std::isfinite(any.hit[k].t));
          }
        }
}

TEST(ConeIntersect, LiesInTheFilterIntervalOfEveryEnclosingBox) {
  Rng rng(5);
  int kept = 0;
  for (int i = 0; i < 200000; ++i) {
    const Case c = random_case(rng, rng.uniform(-3, 30));
    const CurvedHits hits = tied(c.cone, c.ray);
    const Aabb outer = test::random_enclosing_box(rng, bounds(c.cone));
    for (std::size_t k = 0; k < static_cast<std::size_t>(hits.count); ++k) {
      const double t = hits.hit[k].t;
      ASSERT_TRUE(k == 0 || hits.hit[0].t < t);
      ASSERT_TRUE(test::filter_keeps(c.ray, outer, t, t)) << "case " << i;
      ++kept;
    }
  }
  EXPECT_GT(kept, 50000);
}

TEST(ConeBounds, AreExactForAxesParallelToCoordinateAxes) {
  EXPECT_EQ(bounds(kCylinder), (Aabb{{-1, -1, 0}, {1, 1, 2}}));
  EXPECT_EQ(bounds(kFullCone), (Aabb{{-1, -1, 0}, {1, 1, 1}}));
  EXPECT_EQ(bounds(kTruncated), (Aabb{{-3, -3, 0}, {3, 3, 4}}));
  EXPECT_EQ(bounds({{1, 2, 3}, 0, {-1, 2, 3}, 0.5}), (Aabb{{-1, 1.5, 2.5}, {1, 2.5, 3.5}}));
}

TEST(ConeBounds, EncloseBothCirclesTightly) {
  Rng rng(6);
  for (int i = 0; i < 5000; ++i) {
    const Cone c = random_case(rng, 0).cone;
    const Aabb box = bounds(c);
    const WideVec w = test::wide(c.apex) - test::wide(c.base);
    for (int axis = 0; axis < 3; ++axis) {
      const Wide part = sqrt(1 - w[axis] * w[axis] / dot(w, w));
      const Wide b = c.base[axis], a = c.apex[axis], rb = c.base_radius, ra = c.apex_radius;
      const Wide lo = std::min(Wide(b - rb * part), Wide(a - ra * part));
      const Wide hi = std::max(Wide(b + rb * part), Wide(a + ra * part));
      ASSERT_TRUE(Wide(box.lo[axis]) <= lo && Wide(box.hi[axis]) >= hi) << "case " << i;
      const Wide slack =
          0x1p-48 * (rb + ra) + 0x1p-51 * std::max(std::abs(c.base[axis]), std::abs(c.apex[axis]));
      ASSERT_TRUE(Wide(box.lo[axis]) >= lo - slack && Wide(box.hi[axis]) <= hi + slack);
    }
  }
}

TEST(ConeClip, IsTheBoundsCutByTheBox) {
  const Aabb box{{0.5, -9, 0.5}, {9, 0.25, 0.75}};
  EXPECT_EQ(clip(kCylinder, box), (Aabb{{0.5, -1, 0.5}, {1, 0.25, 0.75}}));
  EXPECT_TRUE(clip(kCylinder, {{2, 2, 2}, {3, 3, 3}}).is_empty());
}

TEST(ConeNormal, IsUnitAndPointsOutward) {
  EXPECT_EQ(normal_at(kCylinder, {-5, 0, 1}, {2, 0, 0}, 2.0), (Vec3d{-1, 0, 0}));
  EXPECT_EQ(normal_at(kCylinder, {-5, 0, 1}, {2, 0, 0}, 3.0), (Vec3d{1, 0, 0}));
  EXPECT_EQ(normal_at(kCylinder, {-5, 0, 1}, {2, 0, 0}, 2.5), (Vec3d{-1, 0, 0}));
  const Vec3d narrowing = normal_at(kFullCone, {-5, 0, 0.5}, {1, 0, 0}, 4.5);
  EXPECT_NEAR(narrowing.x, -std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(narrowing.z, std::sqrt(0.5), 1e-15);
  const Vec3d widening = normal_at({{0, 0, 0}, 0, {0, 0, 1}, 1}, {-5, 0, 0.5}, {1, 0, 0}, 4.5);
  EXPECT_NEAR(widening.z, -std::sqrt(0.5), 1e-15);
}

TEST(ConeNormal, IsAgainstTheDirectionExactlyInFront) {
  Rng rng(7);
  int compared = 0;
  for (int i = 0; i < 10000; ++i) {
    const Case c = random_case(rng, rng.uniform(-3, 3));
    if (true_roots(c.cone, c.ray).band < 1e-8) continue;
    const CurvedHits hits = intersect(c.cone, c.ray.org, c.ray.dir);
    for (std::size_t k = 0; k < static_cast<std::size_t>(hits.count); ++k) {
      const Vec3d n = normal_at(c.cone, c.ray.org, c.ray.dir, hits.hit[k].t);
      ASSERT_NEAR(length(n), 1.0, 4e-16);
      ASSERT_EQ(dot(n, c.ray.dir) < 0.0, hits.hit[k].is_front) << "case " << i;
      ++compared;
    }
  }
  EXPECT_GT(compared, 5000);
}

}  // namespace
}  // namespace strahl
