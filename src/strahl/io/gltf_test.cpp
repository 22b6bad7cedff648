// io/gltf_test.cpp - scenes from glTF: numbering, instancing, materials, camera, warnings.
#include <algorithm>
#include <tests/support/gltf_file.h>

#include <gtest/gtest.h>

namespace strahl {
namespace {

using nlohmann::json;
using test::GltfFile;
using test::one_triangle;

std::vector<std::uint32_t> instance_ids(const SceneData& scene) {
  std::vector<std::uint32_t> ids;
  for (const Instance& instance : scene.instances) ids.push_back(instance.instance_id);
  return ids;
}

bool warns(const SceneData& scene, const std::string& words) {
  return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                     [&](const std::string& w) { return w.find(words) != std::string::npos; });
}

TEST(Gltf, KeepsAMeshOnceForManyNodes) {
  GltfFile file = one_triangle();
  file.root["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"mesh", 0}}};
  const SceneData scene = file.read();
  EXPECT_EQ(scene.geometries.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[1].first_geometry, 0u);
  EXPECT_EQ(scene.instances[1].geometry_count, 1u);
}

TEST(Gltf, NumbersMeshNodesDepthFirstInFileOrder) {
  GltfFile file = one_triangle();
  file.root["scenes"] = {{{"nodes", {4, 0}}}};
  file.root["nodes"] = {{{"mesh", 0}, {"translation", {3, 0, 0}}},
                        {{"mesh", 0}, {"translation", {2, 0, 0}}},
                        {{"mesh", 0}, {"translation", {1, 0, 0}}},
                        {{"children", {2}}},
                        {{"children", {3, 1}}}};
  const SceneData scene = file.read();
  ASSERT_EQ(instance_ids(scene), (std::vector<std::uint32_t>{0, 1, 2}));
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(scene.instances[i].to_world, Affine::translation({static_cast<double>(i + 1), 0, 0}));
}

TEST(Gltf, GeometryIdsCountPrimitivesOfAllMeshesEvenSkippedOnes) {
  GltfFile file = one_triangle();
  const json triangles = {{"attributes", {{"POSITION", 0}}}};
  const json points = {{"attributes", {{"POSITION", 0}}}, {"mode", 0}};
  file.root["meshes"] = {{{"primitives", {points, triangles}}},
                         {{"primitives", {triangles}}},
                         {{"primitives", {triangles, triangles}}, {"name", "last"}}};
  file.root["nodes"] = {{{"mesh", 2}, {"children", {1}}}, {{"mesh", 0}}};
  const SceneData scene = file.read();
  ASSERT_EQ(scene.geometries.size(), 4u);
  EXPECT_EQ(scene.geometries[0].size(), 0u);
  EXPECT_EQ(scene.geometries[1].geometry_id, 1u);
  EXPECT_EQ(scene.geometries[2].geometry_id, 3u);
  EXPECT_EQ(scene.geometries[3].geometry_id, 4u);
  EXPECT_EQ(scene.geometries[3].name, "last");
  EXPECT_EQ(scene.instances[0].first_geometry, 2u);
  EXPECT_EQ(scene.instances[0].geometry_count, 2u);
  EXPECT_EQ(scene.instances[1].first_geometry, 0u);
  EXPECT_TRUE(warns(scene, "/meshes/0/primitives/0: points or lines skipped"));
}

TEST(Gltf, GivesAPrimitiveItsMaterialsBaseColour) {
  GltfFile file = one_triangle();
  file.root["materials"] = {json::object(),
                            {{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 0.5, 1, 0.5}}}}}};
  const json attributes = {{"POSITION", 0}};
  file.root["meshes"] = {{{"primitives",
                           {{{"attributes", attributes}, {"material", 1}},
                            {{"attributes", attributes}},
                            {{"attributes", attributes}, {"material", 0}}}}}};
  file.root["nodes"] = {{{"mesh", 0}}};
  const SceneData scene = file.read();
  const auto color = [&](std::size_t g) {
    const auto& materials = scene.geometries[g].materials;
    return scene.materials.at(materials.empty() ? 0 : materials.at(0)).color;
  };
  EXPECT_EQ(color(0), Vec3d(0.25, 0.5, 1));
  EXPECT_EQ(color(1), Vec3d(1, 1, 1));
  EXPECT_EQ(color(2), Vec3d(1, 1, 1));
}

TEST(Gltf, DropsSingularInstancesButKeepsMirroredOnesAndNumbers) {
  GltfFile file = one_triangle();
  file.root["scenes"] = {{{"nodes", {0, 1, 2, 3}}}};
  file.root["nodes"] = {{{"mesh", 0}, {"scale", {1, 1, 0}}},
                        {{"mesh", 0}, {"scale", {-1, 1, 1}}},
                        {{"mesh", 0}, {"rotation", {0, 0, 0, 0}}},
                        {{"mesh", 0}, {"translation", {1e308, 0, 0}}, {"scale", {10, 1, 1}}}};
  const SceneData scene = file.read();
  EXPECT_EQ(instance_ids(scene), (std::vector<std::uint32_t>{1, 3}));
  EXPECT_TRUE(warns(scene, "/nodes/0: instance 0 dropped"));
  EXPECT_TRUE(warns(scene, "/nodes/2: instance 2 dropped"));
}

TEST(Gltf, ShowsTheSceneTheFileChooses) {
  GltfFile file = one_triangle();
  file.root["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {5, 0, 0}}}};
  file.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  EXPECT_EQ(file.read().instances.at(0).to_world.m[0][3], 0);
  file.root["scene"] = 1;
  EXPECT_EQ(file.read().instances.at(0).to_world.m[0][3], 5);
  file.root["scene"] = 2;
  EXPECT_EQ(file.error(), "a.glb: /scene: index 2 into a list of 2 scenes");
}

TEST(Gltf, IsEmptyWithAWarningWithoutASceneOrMeshNodes) {
  GltfFile file = one_triangle();
  file.root["nodes"] = {json::object()};
  EXPECT_TRUE(warns(file.read(), "the scene shows no mesh"));
  file.root.erase("scenes");
  const SceneData scene = file.read();
  EXPECT_TRUE(warns(scene, "the file has no scene"));
  EXPECT_TRUE(scene.geometries.empty());
  EXPECT_TRUE(scene.instances.empty());
}

TEST(Gltf, TurnsTheFirstPerspectiveCameraIntoTheView) {
  GltfFile file = one_triangle();
  file.root["cameras"] = {{{"type", "orthographic"}},
                          {{"perspective", {{"yfov", 1.5707963267948966}, {"aspectRatio", 2}}}}};
  file.root["nodes"] = {{{"mesh", 0}, {"children", {1, 2}}},
                        {{"camera", 0}},
                        {{"camera", 1}, {"translation", {0, 0, 7}}}};
  const SceneData scene = file.read();
  ASSERT_TRUE(scene.view.has_value());
  EXPECT_EQ(scene.view->from, Vec3d(0, 0, 7));
  EXPECT_EQ(scene.view->at, Vec3d(0, 0, 6));
  EXPECT_EQ(scene.view->up, Vec3d(0, 1, 0));
  EXPECT_NEAR(scene.view->fov_degrees, 90, 1e-12);
  EXPECT_EQ(scene.view->width, 2 * scene.view->height);
}

TEST(Gltf, PlacesCopiesOfTheInstancingExtensionBelowTheirNode) {
  GltfFile file = one_triangle();
  const std::size_t t = file.positions({1, 0, 0, 2, 0, 0});
  const std::size_t r =
      file.accessor<std::int16_t>({0, 0, 32767, 0, 0, 0, 0, 32767}, test::kInt16, "VEC4", 4);
  file.root["accessors"][r]["normalized"] = true;
  file.root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const json copies = {{"attributes", {{"TRANSLATION", t}, {"ROTATION", r}}}};
  file.root["nodes"] = {{{"mesh", 0},
                         {"translation", {0, 10, 0}},
                         {"extensions", {{"EXT_mesh_gpu_instancing", copies}}},
                         {"children", {1}}},
                        {{"mesh", 0}}};
  const SceneData scene = file.read();
  ASSERT_EQ(instance_ids(scene), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(scene.instances[0].to_world.point({1, 0, 0}), Vec3d(0, 10, 0));
  EXPECT_EQ(scene.instances[1].to_world.point({1, 0, 0}), Vec3d(3, 10, 0));
  EXPECT_EQ(scene.instances[2].to_world.point({1, 0, 0}), Vec3d(1, 10, 0));

  file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] =
      file.positions({1, 1, 1});
  EXPECT_EQ(file.error(),
            "a.glb: /nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE: "
            "1 elements for 2 copies");
}

TEST(Gltf, KeepsOnlyTheFirstOfVeryManyWarnings) {
  GltfFile file = one_triangle();
  file.root["scenes"][0]["nodes"] = json::array();
  for (int n = 0; n < 150; ++n) {
    file.add("nodes", {{"mesh", 0}, {"scale", {0, 0, 0}}});
    file.root["scenes"][0]["nodes"].push_back(n);
  }
  const SceneData scene = file.read();
  ASSERT_EQ(scene.warnings.size(), 101u);
  EXPECT_EQ(scene.warnings.back(), "and 51 more warnings");
}

}  // namespace
}  // namespace strahl
