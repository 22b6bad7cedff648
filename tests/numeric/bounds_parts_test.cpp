// Bounding volumes around real parts: every vertex and random points of the surface lie inside,
// k-DOPs are nested, oriented boxes are near minimal, hits of the exact test are kept.
#include <array>
#include <numbers>
#include <tests/support/parts.h>
#include <tests/support/random_axes.h>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/bounds/all_volumes.h>
#include <strahl/bounds/volume_cases_test.h>
#include <strahl/geometry/triangle.h>

namespace strahl::test {
namespace {

struct Part {
  std::string name;
  std::vector<TriangleVertices> triangles;
  EnclosedSet set;

  explicit Part(const std::string& file) : name(file), triangles(triangles_of(file)) {
    for (const TriangleVertices& t : triangles) set.add(t);
  }
  Vec3d random_point(Rng& rng) const {
    const TriangleVertices& t = triangles[rng.below(static_cast<std::uint32_t>(triangles.size()))];
    return mixture({t.a, t.b, t.c}, rng);
  }
};

constexpr FitEffort kEfforts[] = {FitEffort::fast, FitEffort::thorough};

template <class V>
void expect_contained(const V& v, const Part& part, int count) {
  std::size_t outside = 0;
  for (const TriangleVertices& t : part.triangles)
    for (const Vec3d& p : {t.a, t.b, t.c}) outside += !v.contains(p);
  Rng rng(1);
  for (int i = 0; i < count; ++i) outside += !v.contains(part.random_point(rng));
  EXPECT_EQ(outside, 0u) << part.name << ' ' << info_of(V::kKind).name;
}

/// Rays at the part that the exact test of one of its triangles calls hits.
template <class V>
void expect_kept(const V& v, const Part& part, int count) {
  Rng rng(2);
  const Aabb& world = part.set.box();
  const double size = norm_max(world.extent());
  for (int i = 0; i < count; ++i) {
    const TriangleVertices& t =
        part.triangles[rng.below(static_cast<std::uint32_t>(part.triangles.size()))];
    const std::array targets{t.a, 0.5 * (t.b + t.c), mixture({t.a, t.b, t.c}, rng), t.c};
    const Vec3d target = targets[static_cast<std::size_t>(i % 4)];
    const double far = std::array{0.5, 1e3, 1e12}[static_cast<std::size_t>(i % 3)];
    const Vec3d dir = i % 5 == 0 ? t.b - t.a : part.random_point(rng) - part.random_point(rng);
    if (dir == Vec3d()) continue;
    const Vec3d org = target - (far * size) * unit(dir);
    const PreparedRay ray = prepared(org, dir, world);
    const auto hit = intersect(ray, t);
    if (!hit || hit->t < 0.0) continue;
    EXPECT_TRUE(keeps(passage(v, ray, world), hit->t))
        << part.name << ' ' << info_of(V::kKind).name;
  }
}

TEST(BoundsOfParts, ContainEveryVertexAndKeepEveryHit) {
  STRAHL_REQUIRE_SHARED("scenes");
  // A million points in all for each kind and effort.
  const int count = is_full_run() ? 100'000 : 2'000;
  for (const std::string& name : real_parts()) {
    const Part part(name);
    for (const BoundingVolumeInfo& info : kBoundingVolumes) {
      with_volume_type(info.kind, [&]<class V>() {
        for (const FitEffort effort : kEfforts) {
          if (effort == FitEffort::thorough && !is_full_run()) continue;
          const V v = V::enclose(part.set, effort);
          expect_contained(v, part, count);
          expect_kept(v, part, count / 5);
        }
      });
    }
  }
}

TEST(BoundsOfParts, NestedDirectionsGiveNestedDops) {
  STRAHL_REQUIRE_SHARED("scenes");
  for (const std::string& name : real_parts()) {
    const EnclosedSet set = Part(name).set;
    const auto d6 = KdopVolume<6>::enclose(set);
    const auto d14 = KdopVolume<14>::enclose(set);
    const auto d18 = KdopVolume<18>::enclose(set);
    const auto d26 = KdopVolume<26>::enclose(set);
    EXPECT_EQ(d6.box(), AabbVolume::enclose(set).box());
    const double thin = 1 + 1e-9;
    EXPECT_LE(d26.volume(), d14.volume() * thin);
    EXPECT_LE(d26.volume(), d18.volume() * thin);
    EXPECT_LE(std::max(d14.volume(), d18.volume()), d6.volume() * thin);
    EXPECT_LE(std::max(d14.half_area(), d18.half_area()), d6.half_area() * thin);
    EXPECT_LE(d26.half_area(), std::min(d14.half_area(), d18.half_area()) * thin);
    Rng rng(3);
    const Aabb box = d6.box();
    for (int i = 0; i < 2000; ++i) {
      const Vec3d p = box.lo + Vec3d{rng.uniform() * box.extent().x, rng.uniform() * box.extent().y,
                                     rng.uniform() * box.extent().z};
      EXPECT_LE(d26.contains(p), d14.contains(p) && d18.contains(p));
      EXPECT_LE(d14.contains(p) || d18.contains(p), d6.contains(p));
    }
  }
}

TEST(BoundsOfParts, OrientedBoxesAreNearMinimal) {
  STRAHL_REQUIRE_SHARED("scenes");
  const int count = is_full_run() ? 10'000 : 1'000;
  for (const std::string& name : real_parts()) {
    const Part part(name);
    const FitCloud cloud(part.set, true);
    Rng rng(4);
    double least_volume = Aabb::kInf, least_area = Aabb::kInf;
    const auto widths = [&](const ObbAxes& axes) {
      const auto width = [&](const Vec3d& n) {
        const auto [lo, hi] = cloud.extent(n);
        return hi - lo;
      };
      return Vec3d{width(axes[0]), width(axes[1]), width(axes[2])};
    };
    for (int i = 0; i < count; ++i) {
      const Vec3d w = widths(random_axes(rng));
      least_volume = std::min(least_volume, box_cost(w, ObbGoal::volume));
      least_area = std::min(least_area, box_cost(w, ObbGoal::area));
    }
    for (const FitEffort effort : kEfforts) {
      const double slack = effort == FitEffort::thorough ? 1.0 : 1.1;  // fast: 1.062 was seen
      EXPECT_LE(box_cost(widths(search_axes(cloud, ObbGoal::volume, effort)), ObbGoal::volume),
                slack * least_volume)
          << name;
      EXPECT_LE(box_cost(widths(search_axes(cloud, ObbGoal::area, effort)), ObbGoal::area),
                slack * least_area)
          << name;
    }
    // As the volume itself is made and measured.
    const double scale = cloud.scale * cloud.scale * cloud.scale;
    const ObbVolume obb = ObbVolume::enclose(part.set, FitEffort::thorough, ObbGoal::volume);
    EXPECT_LE(obb.volume(), 1.05 * scale * least_volume) << name;
    EXPECT_LE(ObbVolume::enclose(part.set).volume(), 1.05 * scale * least_volume) << name;
    EXPECT_LE(obb.volume(), 1.0001 * ObbVolume::enclose_by_covariance(part.set).volume()) << name;
  }
}

}  // namespace
}  // namespace strahl::test
