// geometry/pose_test.cpp - a posed scene is the scene that a file of that pose would give.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/geometry/instance_source.h>

namespace strahl {
namespace {

/// Three instances of one triangle and a ball; the second is where it is by no map at all.
SceneData three() {
  SceneData data;
  data.source = "three";
  data.geometries.resize(2);
  data.geometries[0].mesh =
      make_mesh(std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
  data.geometries[1].kind = PrimitiveKind::sphere;
  data.geometries[1].spheres = {{{3, 0, 0}, 1.0}};
  for (std::uint32_t i = 0; i < 3; ++i)
    data.instances.push_back(
        {0, 2, Affine::translation({5.0 * (i == 1 ? 0 : i + 1), 0, 0}), 10 + i});
  return data;
}

std::vector<Affine> maps() {
  return {Affine::translation({1, 2, 3}) * Affine::rotation(0, 0, std::sin(0.5), std::cos(0.5)),
          Affine::scaling({-2, 1, 0.5}), Affine{}};
}

Scene fresh() {
  SceneData data = three();
  for (std::size_t i = 0; i < 3; ++i) data.instances[i].to_world = maps()[i];
  return Scene(std::move(data));
}

std::string refusal(const std::vector<Affine>& to_world) {
  const Scene scene(three());
  try {
    scene.posed(to_world);
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

TEST(PosedScene, HoldsWhatAFreshOneHolds) {
  const Scene base(three()), expected = fresh();
  const Scene posed = base.posed(maps());
  EXPECT_EQ(posed.hash(), expected.hash());
  EXPECT_NE(posed.hash(), base.hash());
  EXPECT_EQ(posed.to_object(), expected.to_object());
  for (std::uint32_t r = 0; r < expected.size(); ++r) {
    EXPECT_EQ(posed.bounds(r), expected.bounds(r));
    EXPECT_EQ(posed.id_of(r), expected.id_of(r));
  }
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(posed.is_identity(i), i == 2);
    EXPECT_EQ(posed.instances()[i].to_world, maps()[i]);
    EXPECT_EQ(posed.object_frame(i).bounds, expected.object_frame(i).bounds);
  }
  EXPECT_EQ(posed.world_frame().bounds, expected.world_frame().bounds);
}

TEST(PosedScene, BoxesAndMarginsAreNoSmallerThanFreshOnes) {
  const Scene posed = Scene(three()).posed(maps()), expected = fresh();
  EXPECT_TRUE(posed.total_bounds().contains(expected.total_bounds()));
  EXPECT_GE(posed.world_frame().widen_absolute, expected.world_frame().widen_absolute);
  EXPECT_GE(posed.world_frame().widen_per_org, expected.world_frame().widen_per_org);
  EXPECT_GT(expected.world_frame().widen_absolute, 0.0);
}

TEST(PosedScene, SharesGeometryAndOutlivesItsOrigin) {
  auto base = std::make_unique<Scene>(three());
  const Scene posed = base->posed(maps());
  EXPECT_EQ(posed.geometries().data(), base->geometries().data());
  EXPECT_EQ(posed.parts().data(), base->parts().data());
  EXPECT_TRUE(posed.is_pose_of(*base));
  EXPECT_FALSE(posed.is_pose_of(fresh()));
  base.reset();
  EXPECT_EQ(posed.geometries()[1].spheres.size(), 1u);
  EXPECT_EQ(posed.posed(maps()).hash(), posed.hash());
}

TEST(PosedScene, RefusesImpossiblePoses) {
  std::vector<Affine> bad = maps();
  bad.pop_back();
  EXPECT_EQ(refusal(bad), "three: 2 maps for 3 instances");
  bad = maps();
  bad[1] = Affine::scaling({1, 1e-12, 1});
  EXPECT_EQ(
      refusal(bad),
      "three: instance 11: its transformation is singular or nearly so (condition above 2^30)");
  bad[1] = Affine::translation({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  EXPECT_NE(refusal(bad), "accepted");
  bad[1] = Affine::translation({0x1p239, 0, 0}) * Affine::scaling({0x1p199, 0x1p199, 0x1p199});
  EXPECT_EQ(refusal(bad), "accepted");
  bad[1] = Affine::translation({0x1p241, 0, 0});
  EXPECT_EQ(refusal(bad), "three: a transformed coordinate's magnitude is above 2^240");
}

TEST(InstanceSource, OfAPoseKeepsTheObjects) {
  const Scene base(three());
  const InstanceSource rest(base);
  const Scene posed = base.posed(maps());
  const InstanceSource moved(posed, rest), expected(posed);
  EXPECT_EQ(&moved.objects(), &rest.objects());
  EXPECT_EQ(moved.objects(), expected.objects());
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(moved.bounds(i), posed.instance_bounds(i));
  EXPECT_FALSE(moved.bounds(0) == rest.bounds(0));
}

}  // namespace
}  // namespace strahl
