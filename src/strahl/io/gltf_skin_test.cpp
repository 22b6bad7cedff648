// io/gltf_skin_test.cpp - morph targets by default weights and skins at rest.
#include <tests/support/gltf_file.h>

#include <gtest/gtest.h>

namespace strahl {
namespace {

using nlohmann::json;
using test::GltfFile;
using test::one_triangle;

// Vertex 0 follows joint node 1 (z times 3, +10 x), vertex 1 joint node 2 (+20 y), vertex 2 half of
// each. The inverse bind matrix of joint 1 moves by +1 z, that of joint 2 is the identity.
GltfFile skinned_triangle() {
  GltfFile file = one_triangle();
  const std::size_t joints =
      file.accessor<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, test::kUint8, "VEC4", 4);
  const std::size_t weights =
      file.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0}, test::kFloat, "VEC4", 4);
  const std::size_t binds =
      file.accessor<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1,  //
                            1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                           test::kFloat, "MAT4", 16);
  json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = joints;
  attributes["WEIGHTS_0"] = weights;
  file.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", binds}}};
  file.root["scenes"] = {{{"nodes", {0, 1, 2}}}};
  file.root["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {500, 500, 500}}},
                        {{"translation", {10, 0, 0}}, {"scale", {1, 1, 3}}},
                        {{"translation", {0, 20, 0}}}};
  return file;
}

TEST(GltfSkin, MovesVerticesByTheirJointsAndIgnoresTheNode) {
  const SceneData scene = skinned_triangle().read();
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_TRUE(scene.instances[0].to_world.is_identity());
  const TriangleVertices t = scene.geometries.at(0).mesh[0];
  EXPECT_EQ(t.a, Vec3d(10, 0, 3));
  EXPECT_EQ(t.b, Vec3d(1, 20, 0));
  EXPECT_EQ(t.c, Vec3d(5, 11, 1.5));
}

TEST(GltfSkin, GivesEachSkinnedNodeItsOwnGeometryWithTheMeshsId) {
  GltfFile file = skinned_triangle();
  file.root["meshes"].insert(file.root["meshes"].begin(), file.root["meshes"][0]);
  file.root["nodes"][0]["mesh"] = 1;
  file.root["nodes"].push_back({{"mesh", 1}});
  file.root["scenes"][0]["nodes"].push_back(3);
  const SceneData scene = file.read();
  ASSERT_EQ(scene.geometries.size(), 2u);
  ASSERT_EQ(scene.instances.size(), 2u);
  for (const Geometry& geometry : scene.geometries) EXPECT_EQ(geometry.geometry_id, 1u);
  const auto first_vertex = [&](std::size_t i) {
    return scene.geometries.at(scene.instances[i].first_geometry).mesh[0].a;
  };
  EXPECT_EQ(first_vertex(0), Vec3d(10, 0, 3));
  EXPECT_EQ(first_vertex(1), Vec3d(0, 0, 0));
}

TEST(GltfSkin, ReadsNormalizedWeightsAndDividesByTheirSum) {
  GltfFile file = skinned_triangle();
  const std::size_t weights = file.accessor<std::uint8_t>(
      {255, 0, 0, 0, 255, 0, 0, 0, 51, 51, 0, 0}, test::kUint8, "VEC4", 4);
  file.root["accessors"][weights]["normalized"] = true;
  file.root["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = weights;
  const Vec3d c = file.read().geometries.at(0).mesh[0].c;
  EXPECT_EQ(c, Vec3d(5, 11, 1.5));
}

TEST(GltfSkin, AddsFurtherSetsOfJoints) {
  GltfFile file = skinned_triangle();
  json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_1"] = attributes["JOINTS_0"];
  attributes["WEIGHTS_1"] = attributes["WEIGHTS_0"];
  EXPECT_EQ(file.read().geometries.at(0).mesh[0].c, Vec3d(5, 11, 1.5));
  attributes.erase("WEIGHTS_1");
  EXPECT_NE(file.error().find("'WEIGHTS_1' is missing"), std::string::npos);
}

TEST(GltfSkin, RefusesJointsTheSkinDoesNotHave) {
  GltfFile file = skinned_triangle();
  file.root["skins"][0]["joints"] = {1};
  EXPECT_EQ(file.error(),
            "a.glb: /meshes/0/primitives/0/attributes/JOINTS_0: joint 1 of vertex 1, but the skin "
            "has 1");
  file.root["skins"][0]["joints"] = {1, 2, 1};
  EXPECT_EQ(file.error(), "a.glb: /skins/0/inverseBindMatrices: 2 matrices for 3 joints");
  file.root["skins"][0]["joints"] = {1, 3};
  EXPECT_EQ(file.error(), "a.glb: /skins/0/joints/1: index 3 into a list of 3 nodes");
}

TEST(GltfSkin, RefusesAttributesThatDoNotFit) {
  GltfFile file = skinned_triangle();
  json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  const json position = attributes["POSITION"], joints = attributes["JOINTS_0"];
  file.root["accessors"][joints.get<std::size_t>()]["count"] = 2;
  EXPECT_NE(file.error().find("/JOINTS_0: 2 elements for 3 vertices"), std::string::npos);
  attributes = {{"POSITION", position}};
  EXPECT_EQ(file.error(),
            "a.glb: /meshes/0/primitives/0: the mesh has a skin, but the primitive has no "
            "JOINTS_0");
}

GltfFile morphed_triangle() {
  GltfFile file = one_triangle();
  const std::size_t up = file.positions({0, 0, 1, 0, 0, 1, 0, 0, 1});
  const std::size_t right = file.positions({4, 0, 0, 4, 0, 0, 4, 0, 0});
  file.root["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", up}}, {{"POSITION", right}}};
  file.root["nodes"] = {{{"mesh", 0}}};
  return file;
}

TEST(GltfMorph, AppliesTheDefaultWeightsOfTheMesh) {
  GltfFile file = morphed_triangle();
  EXPECT_EQ(file.read().geometries.at(0).mesh[0].b, Vec3d(1, 0, 0));
  file.root["meshes"][0]["weights"] = {2, 0.25};
  EXPECT_EQ(file.read().geometries.at(0).mesh[0].b, Vec3d(2, 0, 2));
}

TEST(GltfMorph, LetsANodeOverrideTheWeightsForItselfOnly) {
  GltfFile file = morphed_triangle();
  file.root["meshes"][0]["weights"] = {2, 0.25};
  file.root["scenes"] = {{{"nodes", {0, 1}}}};
  file.root["nodes"] = {{{"mesh", 0}, {"weights", {0, 1}}, {"translation", {0, 9, 0}}},
                        {{"mesh", 0}}};
  const SceneData scene = file.read();
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].to_world, Affine::translation({0, 9, 0}));
  EXPECT_EQ(scene.geometries.at(scene.instances[0].first_geometry).mesh[0].b, Vec3d(5, 0, 0));
  EXPECT_EQ(scene.geometries.at(scene.instances[1].first_geometry).mesh[0].b, Vec3d(2, 0, 2));
}

TEST(GltfMorph, PrecedesTheSkin) {
  GltfFile file = skinned_triangle();
  const std::size_t up = file.positions({0, 0, 1, 0, 0, 1, 0, 0, 1});
  file.root["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", up}}};
  file.root["meshes"][0]["weights"] = {1};
  EXPECT_EQ(file.read().geometries.at(0).mesh[0].a, Vec3d(10, 0, 6));
}

TEST(GltfMorph, RefusesTargetsThatDoNotFit) {
  GltfFile file = morphed_triangle();
  file.root["meshes"][0]["weights"] = {1, 1, 1};
  EXPECT_EQ(file.error(),
            "a.glb: /meshes/0/primitives/0: has fewer morph targets than the 3 weights of its mesh "
            "or node");
  file.root["meshes"][0]["weights"] = {1, 1};
  file.root["accessors"][1]["count"] = 2;
  EXPECT_EQ(file.error(),
            "a.glb: /meshes/0/primitives/0/targets/0/POSITION: 2 elements for 3 vertices");
}

}  // namespace
}  // namespace strahl
