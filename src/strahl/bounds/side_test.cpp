// The sides of every kind of volume: what they say is inside, and how fast depths change.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/bounds/all_volumes.h>

namespace strahl {
namespace {

Vec3d point(Rng& rng, double reach) {
  const double x = rng.uniform(-reach, reach), y = rng.uniform(-reach, reach);
  return {x, y, rng.uniform(-reach, reach)};
}

template <class V>
std::vector<VolumeSide> sides_of(const V& volume) {
  std::vector<VolumeSide> sides;
  SideList list(sides);
  volume.add_sides_to(list);
  return sides;
}

double least_depth(const std::vector<VolumeSide>& sides, const Vec3d& p) {
  double least = Aabb::kInf;
  for (const VolumeSide& side : sides) least = std::min(least, side.depth(p));
  return least;
}

/// A curved sheet, so that shells have a hole and a sector.
EnclosedSet sheet(Rng& rng) {
  EnclosedSet set;
  for (int i = 0; i < 40; ++i) {
    const Vec3d p = point(rng, 0.4);
    set.add(TriangleVertices{unit(Vec3d{p.x, p.y, 1.0}), unit(Vec3d{p.x + 0.05, p.y, 1.0}),
                             unit(Vec3d{p.x, p.y + 0.05, 1.0})});
  }
  return set;
}

EnclosedSet cloud(Rng& rng) {
  EnclosedSet set;
  for (int i = 0; i < 40; ++i) {
    const Vec3d p = point(rng, 1.0);
    set.add(Vec3d{p.x, 0.5 * p.y + 0.2 * p.x, 0.3 * p.z});
  }
  return set;
}

TEST(VolumeSides, SayWhatIsContainedForEveryKind) {
  Rng rng(1);
  for (const EnclosedSet& set : {sheet(rng), cloud(rng)})
    for (const BoundingVolumeInfo& info : kBoundingVolumes)
      with_volume_type(info.kind, [&]<class V>() {
        const V volume = V::enclose(set, FitEffort::thorough);
        const std::vector<VolumeSide> sides = sides_of(volume);
        int inside = 0;
        for (int i = 0; i < 3000; ++i) {
          const double extent = norm_max(set.box().extent());
          const auto any = rng.below(static_cast<std::uint32_t>(set.points().size()));
          const Vec3d p = i % 2 ? set.box().center() + point(rng, 0.6 * extent)
                                : set.points()[any] + point(rng, 0.02 * extent);
          const double depth = least_depth(sides, p);
          if (std::abs(depth) < 1e-9) continue;
          EXPECT_EQ(volume.contains(p), depth > 0.0) << info.name;
          inside += depth > 0.0;
        }
        EXPECT_GT(inside, 10) << info.name;
      });
}

TEST(VolumeSides, DepthsChangeNoFasterThanPointsMove) {
  Rng rng(2);
  const std::vector<VolumeSide> sides{VolumeSide::plane({1, 2, 3}, 0.5),
                                      VolumeSide::ball({0.1, 0, 0}, 0.7),
                                      VolumeSide::hole({0, 0.2, 0}, 0.3),
                                      VolumeSide::tube({0, 0, 0.1}, unit(Vec3d{1, 1, 0}), 0.4),
                                      VolumeSide::cone({0, 0, -1}, {0, 0, 1}, 0.8, 2.0),
                                      VolumeSide::cone({0, 0, -1}, {0, 0, 1}, 0.0, 2.0)};
  for (const VolumeSide& side : sides)
    for (int i = 0; i < 1000; ++i) {
      const Vec3d p = point(rng, 1.0), q = p + point(rng, i % 2 ? 1.0 : 1e-3);
      EXPECT_LE(std::abs(side.depth(p) - side.depth(q)), length(p - q) * (1 + 1e-9));
    }
}

TEST(VolumeSides, OfWhatIsEmptyHaveNothingInsideAndOfWhatIsEndlessAreNone) {
  EnclosedSet everything;
  everything.add_corner(Vec3d::all(Aabb::kInf));
  for (const BoundingVolumeInfo& info : kBoundingVolumes)
    with_volume_type(info.kind, [&]<class V>() {
      EXPECT_LT(least_depth(sides_of(V{}), {0.1, 0.2, 0.3}), 0.0) << info.name;
      EXPECT_GT(least_depth(sides_of(V::enclose(everything)), {0.1, 0.2, 0.3}), 1e9) << info.name;
    });
}

}  // namespace
}  // namespace strahl
