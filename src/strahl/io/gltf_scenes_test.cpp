// io/gltf_scenes_test.cpp - real glTF scenes: published counts, and extents computed by an
// independent program from the same files (numpy, skins and node transforms applied).
#include <tests/support/shared.h>

#include <gtest/gtest.h>

#include <strahl/io/gltf.h>

namespace strahl {
namespace {

struct Expected {
  const char* file;
  std::size_t unique, instanced, mesh_nodes;
  Vec3d lo, hi;
};

// Counts from the manifest of the scenes.
constexpr Expected kScenes[] = {
    {"CesiumMan.glb",
     4672,
     4672,
     1,
     {-5.69136990e-01, -1.17918354e-07, -1.31000041e-01},
     {0.56913686, 1.50655033, 0.18095406}},
    {"CesiumMilkTruck.glb",
     2856,
     3624,
     3,
     {-2.43091011, 1.45189177e-03, -1.39600003},
     {2.43799996, 2.5843699, 1.39600003}},
    {"RobotExpressive.glb",
     3234,
     3234,
     14,
     {-1.21664216, -0.87134315, -0.46337808},
     {1.21664182, 0.57527282, 0.49866066}},
    {"franka_panda.glb",
     134300,
     134924,
     11,
     {-2.31358764e-01, -2.10045228e-17, -1.29934907e-01},
     {0.35091342, 0.77894518, 0.129392}},
    {"kaykit_city.glb", 14775, 483094, 868, {-25, 0, -25}, {25, 3.05, 25}},
    {"office_floor.glb", 142417, 3433884, 169, {0, 0, 0}, {48, 3, 24}},
};

Aabb world_box(const SceneData& scene) {
  Aabb box;
  for (const Instance& instance : scene.instances)
    for (std::uint32_t g = 0; g < instance.geometry_count; ++g) {
      const VertexView& vertices = scene.geometries[instance.first_geometry + g].mesh.vertices;
      for (std::size_t i = 0; i < vertices.count; ++i)
        box.extend(instance.to_world.point(vertices[i]));
    }
  return box;
}

void expect_near(const Vec3d& got, const Vec3d& wanted) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(got[axis], wanted[axis], 2e-7);
}

TEST(GltfScenes, HaveThePublishedCountsAndTheExtentsComputedElsewhere) {
  STRAHL_REQUIRE_SHARED("scenes/CesiumMan.glb");
  for (const Expected& expected : kScenes) {
    SCOPED_TRACE(expected.file);
    const SceneData scene = read_gltf(map_file(test::shared_dir() / "scenes" / expected.file));
    std::size_t unique = 0, instanced = 0;
    for (const Geometry& geometry : scene.geometries) unique += geometry.size();
    for (const Instance& instance : scene.instances)
      for (std::uint32_t g = 0; g < instance.geometry_count; ++g)
        instanced += scene.geometries[instance.first_geometry + g].size();
    EXPECT_EQ(unique, expected.unique);
    EXPECT_EQ(instanced, expected.instanced);
    EXPECT_EQ(scene.instances.size(), expected.mesh_nodes);
    EXPECT_TRUE(scene.warnings.empty());
    const Aabb box = world_box(scene);
    expect_near(box.lo, expected.lo);
    expect_near(box.hi, expected.hi);
  }
}

}  // namespace
}  // namespace strahl
