// tests/regression/spd_primary_test.cpp - the published numbers of primary rays that hit the
// standard scenes: 513 x 513 rays through the pixels' corners.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
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

std::int64_t count_hits(const Accelerator& accelerator, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  accelerator.closest_hit(make_batch(rays), hits);
  return std::count_if(hits.begin(), hits.end(), [](const Hit& hit) { return hit.is_hit(); });
}

TEST_P(SpdPrimaryRays, AreTheMeasuredOnesForEveryStructure) {
  const auto scene = std::make_shared<const Scene>(generate_scene(GetParam().scene));
  ASSERT_TRUE(scene->data().view);
  const std::vector<Ray> rays = corner_rays(Camera(*scene->data().view));
  ASSERT_EQ(rays.size(), 513u * 513u);
  for (const StructureEntry& entry : all_structures()) {
    const std::string name = entry.name;
    if (name == "brute_force") continue;  // thousands of primitives for each of the rays
    EXPECT_EQ(count_hits(*build(scene, name), rays), GetParam().primary_hits) << name;
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
