// Ray classification on whole scenes: whatever a ray hits is in the list of its cell, and the
// memory stays under the budget while it evicts, with two threads that divide cells at once.
//
// STRAHL_CONFORMANCE=full takes a million rays per scene. The bvh, which brute force checks
// elsewhere, says what is hit.
#include <algorithm>
#include <tests/support/queries.h>
#include <tests/support/shared.h>
#include <thread>

#include <gtest/gtest.h>

#include <strahl/io/load.h>
#include <strahl/structures/ray_classification/ray_classification.h>

namespace strahl::test {
namespace {

constexpr std::size_t kSlice = 20000;

/// From within and around the box in all directions, every other one towards the box.
std::vector<Ray> random_rays(const Aabb& box, std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  const auto any = [&](double reach) {
    Vec3d p;
    for (int a = 0; a < 3; ++a)
      p[a] = box.center()[a] + reach * rng.uniform(-0.5, 0.5) * box.extent()[a];
    return p;
  };
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const bool is_inside = rng.below(2) == 0;
    const Vec3d org = any(is_inside ? 1.0 : 4.0);
    Ray ray{org, any(1.0) - org};
    if (rng.below(8) == 0) ray.dir[static_cast<int>(rng.below(3))] = 0.0;
    if (is_valid(ray)) rays.push_back(ray);
  }
  return rays;
}

/// Lists of all rays against all their hits; returns how many hits there were.
std::size_t check_lists(const RayClassification& structure, const Accelerator& oracle,
                        std::size_t count, std::uint64_t seed, std::uint64_t most_cell_bytes) {
  std::size_t hits = 0;
  for (std::size_t done = 0; done < count; done += kSlice) {
    const std::vector<Ray> rays =
        random_rays(oracle.scene().total_bounds(), std::min(kSlice, count - done), seed + done);
    const AllHits all = all_hits(oracle, make_batch(rays));
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const PreparedRay ray(rays[i], oracle.scene().world_frame());
      const auto plain = structure.candidates_of(ray, false);
      const auto culled = structure.candidates_of(ray, true);
      for (const Hit& hit : hits_of(all, i)) {
        if (!std::binary_search(plain.begin(), plain.end(), hit.reference) ||
            (hit.is_front && !std::binary_search(culled.begin(), culled.end(), hit.reference))) {
          ADD_FAILURE() << "lost: ray " << i << " of slice " << seed + done;
          return hits;
        }
        ++hits;
      }
      if (structure.figures().bytes > most_cell_bytes) {
        ADD_FAILURE() << "above the budget";
        return hits;
      }
    }
  }
  return hits;
}

class RayClassificationLists : public testing::TestWithParam<const char*> {};

TEST_P(RayClassificationLists, HoldWhatIsHitWhileTwoThreadsDivideAndEvict) {
  const auto scene = std::make_shared<const Scene>(load_scene_data(GetParam()));
  const auto oracle = build(scene, "bvh");
  const std::size_t rays = is_full_run() ? 500000 : 400;
  RayClassificationOptions options;
  options.max_candidates = 16, options.patience = 4, options.group_size = 2;
  options.bytes_per_primitive = 256;
  const RayClassification structure(*scene, options, {});
  const std::uint64_t most = 256ull * scene->size(), fixed = structure.report().bytes;
  std::size_t hits[2] = {};
  std::thread other(
      [&] { hits[1] = check_lists(structure, *oracle, rays, 1u << 30, most - fixed); });
  hits[0] = check_lists(structure, *oracle, rays, 0, most - fixed);
  other.join();
  EXPECT_GT(hits[0] + hits[1], rays / 4);
  EXPECT_GT(structure.figures().evicted, 0u);
  ASSERT_NO_THROW(structure.validate(*scene));
  std::printf("%s: %zu rays, %zu hits, %llu cells made, %llu evicted, %llu bytes of %llu\n",
              GetParam(), 2 * rays, hits[0] + hits[1],
              static_cast<unsigned long long>(structure.figures().added),
              static_cast<unsigned long long>(structure.figures().evicted),
              static_cast<unsigned long long>(structure.report().bytes),
              static_cast<unsigned long long>(most));
}

INSTANTIATE_TEST_SUITE_P(Scenes, RayClassificationLists,
                         testing::Values("gen:gears:2", "gen:balls:2", "gen:mount:4",
                                         "gen:tree:6"));

}  // namespace
}  // namespace strahl::test
