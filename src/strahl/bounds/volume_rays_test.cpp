#include <array>

#include <strahl/bounds/volume_cases_test.h>
#include <strahl/geometry/triangle.h>

namespace strahl {
namespace {

using namespace test;

constexpr FitEffort kEfforts[] = {FitEffort::fast, FitEffort::thorough};

template <class V>
class VolumeRays : public ::testing::Test {};
TYPED_TEST_SUITE(VolumeRays, AllVolumes, VolumeNames);

/// Direction on a grid of 2^-4 across w, as nearly as that allows; never 0.
Vec3d nearly_across(const Vec3d& w, Rng& rng) {
  const Vec3d r = grid_point(rng, 4);
  const Vec3d n = norm_max(w) > 0.0 ? cross(unit(w), r) : r;
  const auto snap = [](double v) { return std::nearbyint(v * 16) / 16; };
  const Vec3d d{snap(n.x), snap(n.y), snap(n.z)};
  return d == Vec3d() ? Vec3d{0, 0, 1} : d;
}

TYPED_TEST(VolumeRays, KeepsExactRaysThroughItsPoints) {
  Rng rng(5);
  for (const PointSet& set : grid_sets()) {
    const EnclosedSet enclosed = set.enclosed();
    const Aabb world = enclosed.box();
    for (const FitEffort effort : kEfforts) {
      const TypeParam v = TypeParam::enclose(enclosed, effort);
      for (const Vec3d& p : set.points) {
        const Vec3d other = set.points[rng.below(static_cast<std::uint32_t>(set.points.size()))];
        std::vector<Vec3d> directions{{1, 0, 0},
                                      {0, -1, 0},
                                      {0, 0, 1},
                                      {1, -1, 0},
                                      {0, 1, 1},
                                      grid_point(rng, 4),
                                      nearly_across(p - world.center(), rng),
                                      nearly_across(p - other, rng),
                                      nearly_across(p, rng)};
        if (!(other == p)) directions.push_back(other - p);
        for (const Vec3d& dir : directions) {
          if (dir == Vec3d()) continue;
          for (const double t : {0.0, 0.5, 1.0, 8.0, 0x1p20, 0x1p39}) {
            const Vec3d org = p - t * dir;
            ASSERT_EQ(org + t * dir, p);
            const Interval span = passage(v, prepared(org, dir, world), world);
            EXPECT_TRUE(keeps(span, t))
                << set.name << " t " << t << " span " << span.t_enter << " .. " << span.t_exit
                << " dir " << dir.x << ' ' << dir.y << ' ' << dir.z;
          }
        }
      }
    }
  }
}

/// Rays that the exact test calls hits, aimed at corners, edges, planes and inside, from near, from
/// within and from 1e12 away.
TYPED_TEST(VolumeRays, KeepsEveryHitOfTheExactTest) {
  Rng rng(9);
  std::size_t hits = 0;
  std::vector<PointSet> sets = grid_sets();
  for (PointSet& set : wild_sets()) sets.push_back(std::move(set));
  for (const PointSet& set : sets) {
    if (set.points.size() < 3) continue;
    const EnclosedSet enclosed = set.enclosed();
    const Aabb world = enclosed.box();
    const double size = norm_max(world.extent());
    const TypeParam v = TypeParam::enclose(enclosed, FitEffort::fast);
    for (int i = 0; i < 400; ++i) {
      const std::size_t first = 3 * rng.below(static_cast<std::uint32_t>(set.points.size() / 3));
      const TriangleVertices tri{set.points[first], set.points[first + 1], set.points[first + 2]};
      const std::vector<Vec3d> corners{tri.a, tri.b, tri.c};
      const Vec3d on_edge = 0.5 * (tri.a + tri.b);
      const Vec3d target = i % 4 == 0 ? tri.a : i % 4 == 1 ? on_edge : mixture(corners, rng);
      const double far = std::array{1.0, 1e3, 1e12, 0.0}[static_cast<std::size_t>(i / 4 % 4)];
      const Vec3d from = i % 3 == 0 ? mixture(corners, rng) : mixture(set.points, rng);
      Vec3d dir = target - from;
      if (i % 7 == 0) dir = std::array{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}[i / 7 % 3];
      const Vec3d org = far == 0.0 ? from : target - (far * size / norm_max(dir)) * dir;
      const Ray ray{org, dir};
      if (!is_valid(ray)) continue;
      const PreparedRay p = prepared(org, dir, world);
      const auto hit = intersect(p, tri);
      if (!hit || hit->t < 0.0) continue;
      ++hits;
      EXPECT_TRUE(keeps(passage(v, p, world), hit->t)) << set.name << " ray " << i;
    }
  }
  EXPECT_GT(hits, 3000u);
}

/// Spheres and cones: the canonical hits, tied to their boxes, with tangents and far origins.
TYPED_TEST(VolumeRays, KeepsEveryHitOnCurvedPrimitives) {
  Rng rng(13);
  std::size_t hits = 0;
  const auto point = [&] {
    const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1);
    return Vec3d{x, y, rng.uniform(-1, 1)};
  };
  for (int round = 0; round < 60; ++round) {
    EnclosedSet set;
    std::vector<Sphere> spheres;
    std::vector<Cone> cones;
    const double slim = std::ldexp(1.0, -static_cast<int>(rng.below(24)));
    for (int i = 0; i < round % 4 + 1; ++i) {
      if (round % 3 != 0)
        spheres.push_back({point(), rng.uniform(0.01, 1)}), set.add(spheres.back());
      if (round % 3 != 1) {
        const Vec3d base = point();
        cones.push_back({base, rng.uniform(0, 1), base + slim * point(), rng.uniform(0, 1)});
        set.add(cones.back());
      }
    }
    const Aabb world = set.box();
    const TypeParam v =
        TypeParam::enclose(set, round % 2 == 0 ? FitEffort::fast : FitEffort::thorough);
    for (int i = 0; i < 300; ++i) {
      Vec3d target = 2.0 * point(), dir = point();
      if (i % 3 == 0 && !spheres.empty()) {  // nearly tangent
        const Sphere& s = spheres[rng.below(static_cast<std::uint32_t>(spheres.size()))];
        const Vec3d out = unit(point());
        target = s.center + (s.radius * (1.0 - 1e-15 * rng.below(1000))) * out;
        dir = cross(out, dir);
      } else if (i % 3 == 1 && !cones.empty()) {  // by the rim
        const Cone& c = cones[rng.below(static_cast<std::uint32_t>(cones.size()))];
        const Basis basis(c.apex - c.base);
        const double angle = rng.uniform(0, 7);
        target = c.base + c.base_radius * (std::cos(angle) * basis.u + std::sin(angle) * basis.v);
        if (i % 2 == 0) dir = std::cos(angle) * basis.v - std::sin(angle) * basis.u;
      }
      const double far = std::array{1.0, 1e4, 1e9, 1e12}[static_cast<std::size_t>(i / 3 % 4)];
      const Vec3d org = target - far * dir;
      if (!is_valid({org, dir})) continue;
      const PreparedRay ray = prepared(org, dir, world);
      const Interval span = passage(v, ray, world);
      const auto check = [&](const CurvedHits& found, const Aabb& box, const char* what) {
        const CurvedHits tied = tie_to_box(found, org, dir, box);
        for (int h = 0; h < tied.count; ++h) {
          const double t = tied.hit[static_cast<std::size_t>(h)].t;
          if (t < 0.0) continue;
          ++hits;
          EXPECT_TRUE(keeps(span, t))
              << what << " round " << round << " ray " << i << " slim " << slim << " t " << t
              << " span " << span.t_enter << ' ' << span.t_exit;
        }
      };
      for (const Sphere& s : spheres) check(intersect(s, org, dir), bounds(s), "sphere");
      for (const Cone& c : cones) check(intersect(c, org, dir), bounds(c), "cone");
    }
  }
  EXPECT_GT(hits, 4000u);
}

/// Not only safe, but sharp: the interval starts and ends where the volume does.
TYPED_TEST(VolumeRays, LetsPassNoMoreThanTheVolume) {
  // A shell has a hole, and its sector is approached from outside only: see kinds_test.
  constexpr bool kIsSharp = TypeParam::kKind != BoundingVolumeKind::shell;
  Rng rng(17);
  for (const PointSet& set : grid_sets()) {
    const EnclosedSet enclosed = set.enclosed();
    const TypeParam v = TypeParam::enclose(enclosed, FitEffort::thorough);
    const Aabb world = enclosed.box();
    int passed = 0, missed = 0;
    for (int i = 0; i < 500; ++i) {
      const Vec3d from = 4.0 * unit(grid_point(rng) + Vec3d{1e-3, 0, 0});
      const Vec3d target = i % 2 == 0 ? mixture(set.points, rng) : 2.0 * grid_point(rng);
      const Interval span = passage(v, prepared(from, unit(target - from), world), world);
      const auto at = [&](double t) { return from + t * unit(target - from); };
      if (span.t_enter > span.t_exit) {
        ++missed;
        continue;
      }
      ++passed;
      const double thin = 1e-5;
      EXPECT_FALSE(v.contains(at(span.t_enter - thin))) << set.name;
      EXPECT_FALSE(v.contains(at(span.t_exit + thin))) << set.name;
      if (!kIsSharp || span.t_exit - span.t_enter < 2 * thin) continue;
      EXPECT_TRUE(v.contains(at(span.t_enter + thin))) << set.name;
      EXPECT_TRUE(v.contains(at(span.t_exit - thin))) << set.name;
    }
    EXPECT_GE(passed, 250) << set.name;
    if (v.half_area() < 1.0) {
      EXPECT_GT(missed, 50) << set.name;
    }
  }
}

TYPED_TEST(VolumeRays, NaNsCutNothing) {
  const PointSet set = grid_sets()[10];
  const TypeParam v = TypeParam::enclose(set.enclosed(), FitEffort::fast);
  const Aabb world = set.enclosed().box();
  const PreparedRay ray = prepared({-4, 0.1, 0.2}, {1, 0, 0}, world);
  const typename TypeParam::RayData data(ray, world);
  const Interval span = v.clip(data, {NAN, NAN});
  EXPECT_FALSE(span.t_enter > span.t_exit);
  // A world without bounds leaves nothing certain but the planes of the axes.
  const Aabb endless{Vec3d::all(-Aabb::kInf), Vec3d::all(Aabb::kInf)};
  EXPECT_TRUE(keeps(passage(v, ray, endless), 4.0));
}

TYPED_TEST(VolumeRays, GrowsByTheWideningOfInstances) {
  const PointSet set = grid_sets()[10];
  const EnclosedSet enclosed = set.enclosed();
  const TypeParam v = TypeParam::enclose(enclosed, FitEffort::thorough);
  RayFrame frame;
  frame.bounds = enclosed.box();
  frame.widen_absolute = 0.25;
  for (const Vec3d& p : set.points) {
    for (const Vec3d& shift : {Vec3d{0.25, 0, 0}, Vec3d{0, -0.25, 0}, Vec3d{0.25, 0.25, -0.25}}) {
      const Vec3d dir = cross(shift, Vec3d{0.3, 0.5, 0.9});
      const PreparedRay ray({p + shift - 3.0 * dir, dir}, frame);
      EXPECT_TRUE(keeps(passage(v, ray, frame.bounds), 3.0));
    }
  }
}

}  // namespace
}  // namespace strahl
