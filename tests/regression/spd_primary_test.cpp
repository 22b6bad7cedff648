// tests/regression/spd_primary_test.cpp - the published numbers of primary rays that hit the
// standard scenes: 513 x 513 rays through the pixels' corners.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <tests/support/queries.h>
#include <tests/support/shared.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/catalog/catalog.h>
#include <strahl/io/generators.h>
#include <strahl/render/camera.h>

namespace strahl {
namespace {

struct Expected {
  const char* scene;
  std::int64_t primary_hits;
};

void PrintTo(const Expected& e, std::ostream* out) { *out << e.scene; }

class SpdPrimaryRays : public testing::TestWithParam<Expected> {};

std::vector<Hit> hits_of(const Accelerator& accelerator, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  accelerator.closest_hit(make_batch(rays), hits);
  return hits;
}

std::vector<Ray> every(std::size_t step, const std::vector<Ray>& rays) {
  std::vector<Ray> some;
  for (std::size_t i = 0; i < rays.size(); i += step) some.push_back(rays[i]);
  return some;
}

/// All rays with the default structure; with the others a sixteenth, unless all is asked for.
TEST_P(SpdPrimaryRays, AreTheMeasuredOnesForEveryStructure) {
  const auto scene = std::make_shared<const Scene>(generate_scene(GetParam().scene));
  ASSERT_TRUE(scene->data().view);
  const std::vector<Ray> rays = corner_rays(Camera(*scene->data().view));
  ASSERT_EQ(rays.size(), 513u * 513u);
  const std::vector<Hit> expected = hits_of(*build(scene, kDefaultSpec), rays);
  EXPECT_EQ(
      std::count_if(expected.begin(), expected.end(), [](const Hit& h) { return h.is_hit(); }),
      GetParam().primary_hits);
  const std::size_t step = test::is_full_run() ? 1 : 16;
  const std::vector<Ray> some = every(step, rays);
  for (const StructureEntry& entry : all_structures()) {
    if (entry.name == std::string("brute_force")) continue;  // thousands of tests for each ray
    const std::vector<Hit> hits = hits_of(*build(scene, entry.name), some);
    for (std::size_t i = 0; i < hits.size(); ++i)
      ASSERT_TRUE(test::same_bits(hits[i], expected[i * step])) << entry.name << " ray " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, SpdPrimaryRays,
    testing::Values(Expected{"gen:balls:4", 263169}, Expected{"gen:gears:4", 245332},
                    Expected{"gen:lattice:12", 261170}, Expected{"gen:mount:6", 173686},
                    Expected{"gen:rings:7", 263169}, Expected{"gen:teapot:12", 161546},
                    Expected{"gen:tetra:6", 49950}, Expected{"gen:tree:11", 169909}),
    [](const auto& param) {
      const std::string scene = param.param.scene;
      return scene.substr(4, scene.rfind(':') - 4);
    });

}  // namespace
}  // namespace strahl
