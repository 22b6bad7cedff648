#include <gtest/gtest.h>

#include <strahl/geometry/instance_source.h>

namespace strahl {
namespace {

Geometry ball(const Vec3d& center, double radius) {
  Geometry g;
  g.kind = PrimitiveKind::sphere;
  g.spheres = {{center, radius}};
  return g;
}

/// Geometries: two balls in two geometries, one that cannot be hit.
SceneData three_objects() {
  SceneData data;
  data.geometries = {ball({0, 0, 0}, 1), ball({4, 0, 0}, 1), ball({0, 0, 0}, -1)};
  const Affine moved = Affine::translation({10, 0, 0}) * Affine::scaling({-2, 1, 1});
  data.instances = {{0, 2, {}, 0}, {0, 2, moved, 1}, {1, 1, {}, 2}, {2, 1, {}, 3}, {0, 0, {}, 4}};
  return data;
}

TEST(InstanceSource, SharesObjectsOfTheSameGeometries) {
  const Scene scene(three_objects());
  const InstanceSource source(scene);
  EXPECT_EQ(source.size(), 5u);
  EXPECT_EQ(source.objects(), (std::vector<std::uint32_t>{0, 2, 3, 4}));
  EXPECT_EQ(source.object_of(0), 0u);
  EXPECT_EQ(source.object_of(1), 0u);
  EXPECT_EQ(source.object_of(4), 3u);
}

TEST(InstanceSource, BoundsAreWorldBoxesOfAllThatIsPlaced) {
  const Scene scene(three_objects());
  const InstanceSource source(scene);
  const Aabb own = source.bounds(0), moved = source.bounds(1);
  EXPECT_EQ(own.lo, (Vec3d{-1, -1, -1}));
  EXPECT_EQ(own.hi, (Vec3d{5, 1, 1}));
  EXPECT_EQ(moved.lo, (Vec3d{0, -1, -1}));
  EXPECT_EQ(moved.hi, (Vec3d{12, 1, 1}));
  EXPECT_TRUE(source.bounds(3).is_empty());
  EXPECT_TRUE(source.bounds(4).is_empty());
}

TEST(InstanceSource, BoundsEncloseTheBoxOfEveryReference) {
  const Scene scene(three_objects());
  const InstanceSource source(scene);
  for (std::uint32_t i = 0; i < 3; ++i)
    for (std::uint32_t r = 0; r < scene.reference_count(i); ++r)
      EXPECT_TRUE(source.bounds(i).contains(scene.bounds(scene.first_reference(i) + r))) << i;
}

TEST(InstanceSource, ClipIsTheCommonPartOfTheBoxes) {
  const Scene scene(three_objects());
  const InstanceSource source(scene);
  const Aabb part = source.clip(1, {{6, 0, -9}, {8, 9, 9}});
  EXPECT_EQ(part.lo, (Vec3d{6, 0, -1}));
  EXPECT_EQ(part.hi, (Vec3d{8, 1, 1}));
  EXPECT_TRUE(source.clip(1, {{20, 0, 0}, {21, 1, 1}}).is_empty());
}

TEST(ObjectSource, NumbersPrimitivesOfAllGeometriesInObjectSpace) {
  const Scene scene(three_objects());
  const ObjectSource object(scene, 1);
  ASSERT_EQ(object.size(), 2u);
  EXPECT_EQ(object.bounds(0).lo, (Vec3d{-1, -1, -1}));
  EXPECT_EQ(object.bounds(1).lo, (Vec3d{3, -1, -1}));
  EXPECT_EQ(object.clip(1, {{4, 0, 0}, {9, 9, 9}}).lo, (Vec3d{4, 0, 0}));
  EXPECT_EQ(ObjectSource(scene, 4).size(), 0u);
  EXPECT_TRUE(ObjectSource(scene, 3).bounds(0).is_empty());
}

}  // namespace
}  // namespace strahl
