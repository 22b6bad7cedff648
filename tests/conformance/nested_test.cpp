// Any structure over instances of any structure answers like brute force over all primitives.
#include <cmath>
#include <map>
#include <memory>
#include <tests/conformance/oracle.h>
#include <tests/conformance/scenes.h>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/io/generators.h>

namespace strahl::test {
namespace {

constexpr std::size_t kRays = 200;
constexpr std::uint64_t kSeed = 7;

/// Many overlapping placements of one object, mirrored ones too, and three that differ: with
/// nothing to hit, without geometries, with one geometry more.
SceneData crowd() {
  SceneData data = generate_scene("balls:1");
  data.instances.clear();
  const auto all = static_cast<std::uint32_t>(data.geometries.size());
  Geometry refused;  // an instance of it has no box
  refused.kind = PrimitiveKind::sphere;
  refused.spheres.push_back({{0, 0, 0}, -1.0});
  refused.geometry_id = 90;
  data.geometries.push_back(refused);
  Rng rng(3);
  for (std::uint32_t i = 0; i < 60; ++i) {
    const double angle = 6.28 * rng.uniform();
    const Vec3d mirror{i % 2 ? 0.5 : -0.5, 0.2 + rng.uniform(), 0.5};
    data.instances.push_back(
        {0, all,
         Affine::translation({0.4 * double(i % 8), 0.4 * double(i / 8), rng.uniform()}) *
             Affine::rotation(0, std::sin(angle), 0, std::cos(angle)) * Affine::scaling(mirror),
         i});
  }
  data.instances.push_back({all, 1, Affine::translation({1, 1, 1}), 60});
  data.instances.push_back({0, 0, {}, 61});
  data.instances.push_back({0, all + 1, {}, 62});
  return data;
}

std::vector<NamedScene> nested_scenes() {
  std::vector<NamedScene> scenes{{"crowd", crowd, false}};
  for (const NamedScene& scene : adversarial_scenes())
    if (scene.make().instances.size() > 1 || scene.is_tiny || scene.name == "curved_mix")
      scenes.push_back(scene);
  return scenes;
}

/// Made once for all combinations.
const Expected& expected_of(const NamedScene& named) {
  static std::map<std::string, Expected> cache;
  const auto found = cache.find(named.name);
  if (found != cache.end()) return found->second;
  return cache.emplace(named.name, expected_answers(scene_of(named), kRays, kSeed)).first->second;
}

/// Every structure on top and at the bottom, and levels within levels.
std::vector<std::string> nested_specs() {
  std::vector<std::string> specs{
      "two_level:top=wide_bvh,bottom=wide_bvh",
      "two_level:top=ray_classification,bottom=ray_classification",
      "two_level:top=grid,bottom=(kd_tree:split=sah_sweep)",
      "two_level:top=(grid:mailbox=off),bottom=(grid:mailbox=off)",
      "two_level:top=(two_level:top=grid,bottom=bih),bottom=(two_level:top=octree,bottom=grid)",
      "two_level:top=(two_level:top=two_level,bottom=two_level),bottom=(two_level:top=two_level,"
      "bottom=(two_level:bottom=kd_tree))"};
  for (const StructureEntry& entry : all_structures()) {
    specs.push_back("two_level:top=" + std::string(entry.name));
    specs.push_back("two_level:bottom=" + std::string(entry.name));
  }
  return specs;
}

class Nested : public testing::TestWithParam<std::string> {};

TEST_P(Nested, AnswersLikeBruteForceOverAllPrimitives) {
  for (const NamedScene& named : nested_scenes()) {
    SCOPED_TRACE(named.name);
    ASSERT_EQ(first_difference(scene_of(named), GetParam(), expected_of(named)), "");
  }
}

INSTANTIATE_TEST_SUITE_P(Specs, Nested, testing::ValuesIn(nested_specs()),
                         [](const auto& spec) { return "number_" + std::to_string(spec.index); });

}  // namespace
}  // namespace strahl::test
