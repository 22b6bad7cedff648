// io/gltf_nodes_test.cpp - node transforms and the checks that make the hierarchy a forest.
#include <cmath>
#include <tests/support/gltf_file.h>

#include <gtest/gtest.h>

namespace strahl {
namespace {

using nlohmann::json;
using test::GltfFile;
using test::one_triangle;

const double kHalf = std::sqrt(0.5);

Affine placed(const json& nodes) {
  GltfFile file = one_triangle();
  file.root["nodes"] = nodes;
  return file.read().instances.at(0).to_world;
}

std::string error(const json& nodes) {
  GltfFile file = one_triangle();
  file.root["nodes"] = nodes;
  return file.error();
}

TEST(GltfNodes, ScalesThenRotatesThenTranslates) {
  const Affine map = placed({{{"mesh", 0},
                              {"translation", {10, 20, 30}},
                              {"rotation", {0, 0, kHalf, kHalf}},
                              {"scale", {2, 3, 4}}}});
  // x is doubled, then turned towards y, then moved.
  const Vec3d p = map.point({1, 0, 1});
  EXPECT_NEAR(p.x, 10, 1e-12);
  EXPECT_NEAR(p.y, 22, 1e-12);
  EXPECT_NEAR(p.z, 34, 1e-12);
}

TEST(GltfNodes, NormalisesRotations) {
  const Vec3d p = placed({{{"mesh", 0}, {"rotation", {0, 0, 5, 5}}}}).point({1, 0, 0});
  EXPECT_NEAR(p.x, 0, 1e-15);
  EXPECT_NEAR(p.y, 1, 1e-15);
}

TEST(GltfNodes, ReadsMatricesByColumns) {
  const Affine map =
      placed({{{"mesh", 0}, {"matrix", {1, 2, 3, 0, 0, 5, 6, 0, 0, 8, 9, 0, 10, 11, 12, 1}}}});
  EXPECT_EQ(map.m[0], (std::array<double, 4>{1, 0, 0, 10}));
  EXPECT_EQ(map.m[1], (std::array<double, 4>{2, 5, 8, 11}));
  EXPECT_EQ(map.m[2], (std::array<double, 4>{3, 6, 9, 12}));
}

TEST(GltfNodes, RefusesAProjectiveMatrix) {
  EXPECT_EQ(error({{{"mesh", 0}, {"matrix", {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}}),
            "a.glb: /nodes/0/matrix: the last row of the matrix is not 0 0 0 1");
}

TEST(GltfNodes, AppliesParentsAfterChildren) {
  const Affine map = placed(
      {{{"children", {1}}, {"scale", {2, 2, 2}}}, {{"mesh", 0}, {"translation", {1, 0, 0}}}});
  EXPECT_EQ(map.point({1, 0, 0}), Vec3d(4, 0, 0));
}

TEST(GltfNodes, FollowsAChainOfAHundredThousandNodes) {
  GltfFile file = one_triangle();
  constexpr int kLength = 100'000;
  json& nodes = file.root["nodes"] = json::array();
  for (int n = 1; n < kLength; ++n) nodes.push_back({{"children", {n}}});
  nodes.push_back({{"mesh", 0}});
  nodes[0]["translation"] = {1, 2, 3};
  EXPECT_EQ(file.read().instances.at(0).to_world, Affine::translation({1, 2, 3}));
}

TEST(GltfNodes, RefusesCycles) {
  EXPECT_EQ(error({{{"mesh", 0}}, {{"children", {2}}}, {{"children", {1}}}}),
            "a.glb: /nodes/1: the node is below itself: the hierarchy has a cycle");
  EXPECT_NE(error({{{"children", {0}}}}).find("has a cycle"), std::string::npos);
}

TEST(GltfNodes, RefusesANodeInTwoPlaces) {
  EXPECT_EQ(error({{{"children", {1, 2}}}, {{"children", {2}}}, json::object()}),
            "a.glb: /nodes/1/children/0: node 2 is already a child of node 0");
  GltfFile file = one_triangle();
  file.root["nodes"] = {{{"children", {1}}}, {{"mesh", 0}}};
  file.root["scenes"] = {{{"nodes", {0, 1}}}};
  EXPECT_EQ(file.error(), "a.glb: /scenes/0/nodes/1: node 1 would appear twice in the hierarchy");
  file.root["scenes"] = {{{"nodes", {0, 0}}}};
  EXPECT_EQ(file.error(), "a.glb: /scenes/0/nodes/1: node 0 would appear twice in the hierarchy");
}

TEST(GltfNodes, CitesThePlaceOfAWrongType) {
  EXPECT_EQ(error({{{"mesh", 0}, {"translation", {1, "2", 3}}}}),
            "a.glb: /nodes/0/translation/1: must be a number, not string");
  EXPECT_EQ(error({{{"mesh", 0}, {"scale", {1, 2}}}}),
            "a.glb: /nodes/0/scale: must hold 3 numbers");
  EXPECT_EQ(error({{{"mesh", -1}}}), "a.glb: /nodes/0/mesh: must be an integer of 0 to 2^53");
  EXPECT_EQ(error({{{"mesh", 0.5}}}), "a.glb: /nodes/0/mesh: must be an integer");
  EXPECT_EQ(error({{{"mesh", 1}}}), "a.glb: /nodes/0/mesh: index 1 into a list of 1 meshes");
  EXPECT_EQ(error({7}), "a.glb: /nodes/0: must be an object, not number");
}

}  // namespace
}  // namespace strahl
