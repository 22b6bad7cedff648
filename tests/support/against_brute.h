// tests/support/against_brute.h - answers of a structure held against those of brute force, and
// rays that make trouble at given points.
#pragma once

#include <string>
#include <tests/support/queries.h>
#include <vector>

#include <gtest/gtest.h>

namespace strahl::test {

/// Random point of a box.
inline Vec3d point_in(const Aabb& box, Rng& rng) {
  Vec3d p;
  for (int axis = 0; axis < 3; ++axis) p[axis] = rng.uniform(box.lo[axis], box.hi[axis]);
  return p;
}

/// Rays from, to and along lines between the points and the axes, and some that just cross the box.
inline std::vector<Ray> rays_through(const std::vector<Vec3d>& points, const Aabb& box, int count,
                                     std::uint64_t seed) {
  Rng rng(seed);
  const auto pick = [&] { return points[rng.below(static_cast<std::uint32_t>(points.size()))]; };
  const double reach = norm_max(box.extent());
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Vec3d a = pick(), b = pick();
    if (a == b) continue;
    Vec3d along;
    along[static_cast<int>(rng.below(3))] = rng.below(2) ? reach : -reach;
    rays.push_back({a - 2.0 * (b - a), b - a});
    rays.push_back({a, b - a});
    rays.push_back({a, b - a, 0.0, 1.0});
    rays.push_back({b - along, along});
    rays.push_back({0.5 * (a + b) - along, along});
    rays.push_back({point_in(box, rng), a - point_in(box, rng)});
    rays.push_back({point_in(box, rng) - along, point_in(box, rng) - point_in(box, rng) + along});
  }
  return rays;
}

/// Builds, validates, and compares all, first and any hits bit by bit.
inline void expect_same_answers(const std::shared_ptr<const Scene>& scene,
                                const std::vector<Ray>& rays, const std::string& spec) {
  const auto built = build(scene, spec), oracle = build(scene, "brute_force");
  ASSERT_NO_THROW(built->validate()) << spec;
  const RayBatch batch = make_batch(rays);
  const AllHits got = all_hits(*built, batch), expected = all_hits(*oracle, batch);
  ASSERT_EQ(got.splits, expected.splits) << spec;
  for (std::size_t i = 0; i < got.hits.size(); ++i)
    ASSERT_TRUE(same_bits(got.hits[i], expected.hits[i])) << spec;
  const std::vector<Hit> first = closest_hits(*built, batch),
                         nearest = closest_hits(*oracle, batch);
  for (std::size_t i = 0; i < rays.size(); ++i)
    ASSERT_TRUE(same_bits(first[i], nearest[i])) << spec << " ray " << i;
  ASSERT_EQ(any_hits(*built, batch), any_hits(*oracle, batch)) << spec;
}

/// Sums over closest hits.
inline Counters work_of(const Accelerator& accelerator, const std::vector<Ray>& rays) {
  BatchContext counting;
  counting.count_work = true;
  std::vector<Hit> hits(rays.size());
  return accelerator.closest_hit(make_batch(rays), hits, counting).counters;
}

}  // namespace strahl::test
