#include <gtest/gtest.h>

#include <strahl/structures/wide_bvh/wide_ids.h>

namespace strahl {
namespace {

/// Parts of one, two and three triangles under two instances.
Scene parts() {
  SceneData data;
  for (std::uint32_t g = 0; g < 3; ++g) {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i <= g; ++i) indices.insert(indices.end(), {0, 1, 2});
    Geometry geometry;
    geometry.mesh = make_mesh(std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, indices);
    geometry.geometry_id = 10 + g;
    data.geometries.push_back(std::move(geometry));
  }
  for (std::uint32_t i = 0; i < 2; ++i)
    data.instances.push_back({0, 3, Affine::translation({double(i), 0, 0}), 50 + i});
  return Scene(std::move(data));
}

TEST(WideIds, AreThoseOfTheSceneInWhateverOrderTheyAreAskedFor) {
  const Scene scene = parts();
  ASSERT_EQ(scene.size(), 12u);
  WideIds ids(scene);
  for (std::uint32_t stride = 1; stride < 12; ++stride)
    for (std::uint32_t i = 0; i < 12; ++i) {
      const std::uint32_t reference = i * stride % 12;
      PrimitiveId id{};
      ids.put(reference, id);
      EXPECT_EQ(id, scene.id_of(reference)) << reference << " in steps of " << stride;
    }
}

}  // namespace
}  // namespace strahl
