// io/deform_test.cpp - skins and morph targets in motion.
#include <numbers>
#include <tests/support/gltf_file.h>

#include <gtest/gtest.h>

namespace strahl {
namespace {

using nlohmann::json;
using test::GltfFile;
using test::one_triangle;

RiggedScene read(const GltfFile& file) {
  return read_rigged_gltf(test::memory_file(file.glb(), "a.glb"));
}

json animation(GltfFile& file, int node, const char* path, const std::vector<float>& times,
               const std::vector<float>& values) {
  const std::string name = path;
  const int width = name == "rotation" ? 4 : name == "weights" ? 1 : 3;
  const char* type = width == 4 ? "VEC4" : width == 3 ? "VEC3" : "SCALAR";
  const json sampler = {
      {"input", file.accessor(times, test::kFloat, "SCALAR", 1)},
      {"output", file.accessor(values, test::kFloat, type, static_cast<std::size_t>(width))}};
  return {{"samplers", {sampler}},
          {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}};
}

/// Vertex 0 follows node 1, vertex 1 node 2 below it, vertex 2 half of each.
GltfFile skinned() {
  GltfFile file = one_triangle();
  const std::size_t joints =
      file.accessor<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, test::kUint8, "VEC4", 4);
  const std::size_t weights =
      file.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0}, test::kFloat, "VEC4", 4);
  json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = joints, attributes["WEIGHTS_0"] = weights;
  file.root["skins"] = {{{"joints", {1, 2}}}};
  file.root["scenes"] = {{{"nodes", {0, 1}}}};
  file.root["nodes"] = {{{"mesh", 0}, {"skin", 0}},
                        {{"translation", {0, 0, 1}}, {"children", {2}}},
                        {{"translation", {0, 0, 2}}}};
  return file;
}

std::vector<Vec3d> vertices_at(const RiggedScene& rigged, double seconds) {
  const Poser poser(rigged.rig, rigged.animations.at(0),
                    std::vector<Affine>(rigged.scene.instances.size()));
  const Shaper shaper(poser, rigged.deformers);
  const std::vector<MovedVertices> moved = shaper.at(seconds);
  std::vector<Vec3d> vertices;
  for (const MovedVertices& m : moved)
    for (std::size_t i = 0; i < m.vertices.count; ++i) vertices.push_back(m.vertices[i]);
  return vertices;
}

TEST(Deform, ASkinFollowsItsJointsAndThoseAbove) {
  GltfFile file = skinned();
  file.root["animations"] = {animation(file, 1, "translation", {0, 2}, {0, 0, 1, 4, 0, 1})};
  const RiggedScene rigged = read(file);
  EXPECT_TRUE(rigged.scene.warnings.empty());
  ASSERT_EQ(rigged.deformers.size(), 1u);
  // The triangle's corners are (0 0 0), (1 0 0), (0 1 0).
  const auto at = vertices_at(rigged, 1.0);
  ASSERT_EQ(at.size(), 3u);
  EXPECT_EQ(at[0], Vec3d(2, 0, 1));
  EXPECT_EQ(at[1], Vec3d(3, 0, 3));
  EXPECT_EQ(at[2], Vec3d(2, 1, 2));
}

TEST(Deform, AJointTurnsWhatHangsOnIt) {
  GltfFile file = skinned();
  const float half = std::sqrt(0.5f);
  file.root["animations"] = {
      animation(file, 2, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, half, half})};
  const auto at = vertices_at(read(file), 1.0);  // a quarter about z
  EXPECT_EQ(at[0], Vec3d(0, 0, 1));
  EXPECT_NEAR(at[1].x, 0.0, 1e-7);
  EXPECT_NEAR(at[1].y, 1.0, 1e-7);
  EXPECT_NEAR(at[2].x, -0.5, 1e-7);  // half of (0 1) and (-1 0)
  EXPECT_NEAR(at[2].y, 0.5, 1e-7);
}

TEST(Deform, AtRestHasTheBitsOfTheSceneAsRead) {
  GltfFile file = skinned();
  file.root["nodes"][2]["rotation"] = {0.1, 0.2, 0.3, 0.927};
  file.root["animations"] = {animation(file, 1, "translation", {0, 2}, {0, 0, 1, 4, 0, 1})};
  const RiggedScene rigged = read(file);
  const auto at = vertices_at(rigged, 0.0);
  const TriangleMesh& mesh = rigged.scene.geometries.at(0).mesh;
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(at.at(i), mesh.vertices[i]);
  const SceneData plain = read_gltf(test::memory_file(file.glb(), "a.glb"));
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(plain.geometries.at(0).mesh.vertices[i], mesh.vertices[i]);
}

/// Two targets: one lifts vertex 0 by 1, the other moves all by 2 along x.
GltfFile morphed() {
  GltfFile file = one_triangle();
  file.root["nodes"] = {{{"mesh", 0}}};
  const std::size_t lift =
      file.accessor<float>({0, 0, 1, 0, 0, 0, 0, 0, 0}, test::kFloat, "VEC3", 3);
  const std::size_t shift =
      file.accessor<float>({2, 0, 0, 2, 0, 0, 2, 0, 0}, test::kFloat, "VEC3", 3);
  file.root["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", lift}},
                                                        {{"POSITION", shift}}};
  return file;
}

TEST(Deform, AnimatedWeightsBlendTheTargets) {
  GltfFile file = morphed();
  file.root["animations"] = {animation(file, 0, "weights", {0, 1}, {0, 0, 1, 0.5})};
  const RiggedScene rigged = read(file);
  ASSERT_EQ(rigged.deformers.size(), 1u);
  ASSERT_EQ(rigged.animations.at(0).tracks.at(0).count, 2u);
  const auto at = vertices_at(rigged, 0.5);
  EXPECT_EQ(at.at(0), Vec3d(0.5, 0, 0.5));
  EXPECT_EQ(at.at(1), Vec3d(1.5, 0, 0));
  EXPECT_EQ(vertices_at(rigged, 9.0).at(0), Vec3d(1, 0, 1));
  EXPECT_EQ(rigged.scene.geometries.at(0).mesh.vertices[0], Vec3d(0, 0, 0)) << "at rest";
}

TEST(Deform, WeightsMayBeStepsAndSplines) {
  GltfFile file = morphed();
  file.root["animations"] = {animation(file, 0, "weights", {0, 1}, {0, 0.5, 1, 0})};
  file.root["animations"][0]["samplers"][0]["interpolation"] = "STEP";
  EXPECT_EQ(vertices_at(read(file), 0.9).at(0), Vec3d(1, 0, 0));
  // In-tangents, values, out-tangents of both targets per time; flat, so half way is the mean.
  file = morphed();
  file.root["animations"] = {
      animation(file, 0, "weights", {0, 1}, {0, 0, 0, 0.5, 0, 0, 0, 0, 1, 0, 0, 0})};
  file.root["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE";
  EXPECT_EQ(vertices_at(read(file), 0.5).at(0), Vec3d(0.5, 0, 0.5));
}

TEST(Deform, OneMeshMayBlendDifferentlyAtEachNode) {
  GltfFile file = morphed();
  file.root["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {0, 9, 0}}}};
  file.root["scenes"] = {{{"nodes", {0, 1}}}};
  file.root["animations"] = {animation(file, 1, "weights", {0, 1}, {0, 0, 1, 1})};
  const RiggedScene rigged = read(file);
  ASSERT_EQ(rigged.scene.geometries.size(), 2u);
  ASSERT_EQ(rigged.deformers.size(), 1u);
  EXPECT_EQ(rigged.deformers[0].geometry, rigged.scene.instances[1].first_geometry);
  EXPECT_NE(rigged.deformers[0].geometry, rigged.scene.instances[0].first_geometry);
}

TEST(Deform, WhatNothingMovesStays) {
  GltfFile file = skinned();
  file.root["nodes"].push_back({{"name", "idle"}});
  file.root["scenes"][0]["nodes"].push_back(3);
  file.root["animations"] = {animation(file, 3, "translation", {0, 2}, {0, 0, 0, 4, 0, 0})};
  const RiggedScene rigged = read(file);
  EXPECT_EQ(rigged.deformers.size(), 1u);
  EXPECT_TRUE(vertices_at(rigged, 1.0).empty());
}

TEST(Deform, MistakesAreNamed) {
  const auto error_of = [](const GltfFile& file) { return test::error_of([&] { read(file); }); };
  GltfFile file = morphed();
  file.root["animations"] = {animation(file, 0, "weights", {0, 1}, {0, 0, 1})};
  EXPECT_EQ(error_of(file), "a.glb: /animations/0/samplers/0/output: 3 values for 2 times");
  file = one_triangle();
  file.root["nodes"] = {{{"mesh", 0}}};
  file.root["animations"] = {animation(file, 0, "weights", {0, 1}, {0, 1})};
  EXPECT_EQ(error_of(file),
            "a.glb: /animations/0/channels/0/target/node: the mesh of the node has no morph "
            "targets");
  file = skinned();
  file.root["animations"] = {animation(file, 1, "weights", {0, 1}, {0, 1})};
  EXPECT_EQ(error_of(file),
            "a.glb: /animations/0/channels/0/target/node: the node has no mesh whose weights could "
            "move");
}

}  // namespace
}  // namespace strahl
