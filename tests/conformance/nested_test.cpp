// Any structure over instances of any structure answers like brute force over all primitives.
#include <cmath>
#include <map>
#include <memory>
#include <tests/conformance/oracle.h>
#include <tests/conformance/scenes.h>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/catalog/erased.h>
#include <strahl/geometry/instance_source.h>
#include <strahl/io/generators.h>
#include <strahl/query/instance_visitor.h>
#include <strahl/structures/brute_force/brute_force.h>
#include <strahl/structures/bvh/bvh.h>
#include <strahl/structures/grid/grid.h>
#include <strahl/structures/kd_tree/kd_tree.h>

namespace strahl::test {
namespace {

constexpr std::size_t kRays = 500;
constexpr std::uint64_t kSeed = 7;

/// Top over the instances of the scene, one Bottom per object.
template <class Top, class Bottom>
class Nested {
 public:
  using Options = BruteForceOptions;
  static constexpr const char* kName = "nested";
  static constexpr const char* kTitle = "a structure over instances of structures";
  static constexpr bool kRefersOnce = Top::kRefersOnce && Bottom::kRefersOnce;

  Nested(const Scene& scene, const Options&, const BuildContext& context)
      : instances_(scene), top_(instances_, {}, context) {
    for (const std::uint32_t instance : instances_.objects())
      bottoms_.push_back(std::make_unique<Bottom>(ObjectSource(scene, instance),
                                                  typename Bottom::Options{}, context));
    for (std::uint32_t i = 0; i < instances_.size(); ++i)
      bottom_of_.push_back(bottoms_[instances_.object_of(i)].get());
  }
  template <class Q, class C>
  void trace(SceneVisitor& prims, const PreparedRay& ray, Q& query, C& counters) const {
    InstanceVisitor<Bottom> instances(prims.scene(), bottom_of_);
    top_.trace(instances, ray, query, counters);
  }
  BuildReport report() const { return top_.report(); }
  void validate(const Scene& scene) const {
    top_.validate(instances_);
    for (const std::uint32_t instance : instances_.objects())
      bottom_of_[instance]->validate(ObjectSource(scene, instance));
  }
  void hash_into(Hash64& hash) const { top_.hash_into(hash); }

 private:
  InstanceSource instances_;
  Top top_;
  std::vector<std::unique_ptr<Bottom>> bottoms_;
  std::vector<const Bottom*> bottom_of_;
};

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

template <class T>
class NestedTest : public testing::Test {};

using Combinations = testing::Types<Nested<BruteForce, Bvh>, Nested<Bvh, BruteForce>,
                                    Nested<Bvh, Bvh>, Nested<Bvh, KdTree>, Nested<Bvh, Grid>,
                                    Nested<KdTree, Bvh>, Nested<KdTree, Grid>, Nested<Grid, Bvh>,
                                    Nested<Grid, KdTree>, Nested<Grid, Grid>>;
TYPED_TEST_SUITE(NestedTest, Combinations);

TYPED_TEST(NestedTest, AnswersLikeBruteForceOverAllPrimitives) {
  for (const NamedScene& named : nested_scenes()) {
    SCOPED_TRACE(named.name);
    const auto scene = scene_of(named);
    const Expected& expected = expected_of(named);
    const auto built = make_entry<TypeParam>().build(scene, {}, {});
    ASSERT_NO_THROW(built->validate());
    ASSERT_EQ(first_difference(ask(*built, expected.set, {}), expected.answers), "");
  }
}

}  // namespace
}  // namespace strahl::test
