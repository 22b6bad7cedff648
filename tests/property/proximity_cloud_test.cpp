// Proximity clouds against the plain grid on scenes with much empty space: the same answers in at
// most half the steps.
#include <algorithm>
#include <string>
#include <tests/support/queries.h>

#include <gtest/gtest.h>

#include <strahl/io/load.h>

namespace strahl::test {
namespace {

/// Rays from a sphere around the scene to points in its middle.
std::vector<Ray> rays_across(const Aabb& box, int count) {
  Rng rng(1);
  const auto any = [&](double reach) {
    const double x = rng.uniform(-reach, reach), y = rng.uniform(-reach, reach);
    return Vec3d{x, y, rng.uniform(-reach, reach)};
  };
  const Vec3d extent = box.extent();
  std::vector<Ray> rays;
  while (rays.size() < static_cast<std::size_t>(count)) {
    const Vec3d out = any(1.0), share = any(0.25);
    if (dot(out, out) > 1.0 || dot(out, out) < 0.01) continue;
    Vec3d target = box.center();
    for (int a = 0; a < 3; ++a) target[a] += share[a] * extent[a];
    const Vec3d org = box.center() + length(extent) / length(out) * out;
    rays.push_back({org, target - org});
  }
  return rays;
}

class ProximityCloudSteps : public testing::TestWithParam<const char*> {};

TEST_P(ProximityCloudSteps, AreAtMostHalfThoseOfTheGrid) {
  const auto scene = std::make_shared<const Scene>(load_scene_data(GetParam()));
  const std::vector<Ray> rays = rays_across(scene->world_frame().bounds, 4000);
  const auto grid = build(scene, "grid"), cloud = build(scene, "proximity_cloud");
  BatchContext counting;
  counting.count_work = true;
  std::vector<Hit> hits(rays.size()), same_hits(rays.size());
  const Counters steps = grid->closest_hit(make_batch(rays), hits, counting).counters;
  const Counters jumps = cloud->closest_hit(make_batch(rays), same_hits, counting).counters;
  EXPECT_TRUE(std::equal(hits.begin(), hits.end(), same_hits.begin(),
                         [](const Hit& a, const Hit& b) { return same_bits(a, b); }));
  EXPECT_LE(2 * jumps.traversal_steps, steps.traversal_steps);
  EXPECT_EQ(jumps.leaves - jumps.empty_leaves, steps.leaves - steps.empty_leaves);
  EXPECT_EQ(jumps.primitives, steps.primitives);
  std::vector<std::uint32_t> counts(rays.size());
  const Counters all_steps = grid->count_hits(make_batch(rays), counts, counting).counters;
  const Counters all_jumps = cloud->count_hits(make_batch(rays), counts, counting).counters;
  EXPECT_LE(2 * all_jumps.traversal_steps, all_steps.traversal_steps);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ProximityCloudSteps,
                         testing::Values("gen:stadium", "gen:tree", "gen:tetra"));

}  // namespace
}  // namespace strahl::test
