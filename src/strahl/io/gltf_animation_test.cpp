// io/gltf_animation_test.cpp - animations of glTF files: hierarchy, channels, mistakes.
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

/// Node 0 carries node 1, which shows the mesh; node 1 is moved by one channel.
struct Animated {
  GltfFile file = one_triangle();
  json sampler, channel;

  Animated(const std::vector<float>& times, const std::vector<float>& values, const char* path) {
    file.root["nodes"] = {{{"children", {1}}, {"translation", {0, 0, 2}}},
                          {{"mesh", 0}, {"name", "shown"}}};
    const bool is_rotation = path == std::string("rotation");
    sampler = {{"input", file.accessor(times, test::kFloat, "SCALAR", 1)},
               {"output", file.accessor(values, test::kFloat, is_rotation ? "VEC4" : "VEC3",
                                        is_rotation ? 4 : 3)}};
    channel = {{"sampler", 0}, {"target", {{"node", 1}, {"path", path}}}};
  }
  RiggedScene rigged() {
    file.root["animations"] = {
        {{"name", "move"}, {"samplers", {sampler}}, {"channels", {channel}}}};
    return read(file);
  }
  std::string error() {
    return test::error_of([this] { rigged(); });
  }
};

Animated shift() { return {{0, 2}, {0, 0, 0, 4, 0, 0}, "translation"}; }

TEST(GltfAnimation, MovesNodesBelowTheirParents) {
  RiggedScene rigged = shift().rigged();
  ASSERT_EQ(rigged.animations.size(), 1u);
  EXPECT_EQ(rigged.animations[0].name, "move");
  EXPECT_EQ(rigged.animations[0].duration, 2.0);
  EXPECT_EQ(rigged.rig.nodes[1].name, "shown");
  EXPECT_EQ(rigged.rig.nodes[1].parent, 0u);
  std::vector<Affine> places{rigged.scene.instances[0].to_world};
  const Poser poser(rigged.rig, rigged.animations[0], places);
  EXPECT_EQ(poser.at(0.0), places) << "the bits of the scene as read";
  EXPECT_EQ(poser.at(1.0)[0], Affine::translation({2, 0, 2}));
}

TEST(GltfAnimation, KnowsAllInterpolations) {
  Animated step = shift();
  step.sampler["interpolation"] = "STEP";
  EXPECT_EQ(step.rigged().animations[0].tracks[0].interpolation, Interpolation::step);
  Animated cubic({0, 1}, std::vector<float>(18, 1.0f), "scale");
  cubic.sampler["interpolation"] = "CUBICSPLINE";
  EXPECT_EQ(cubic.rigged().animations[0].tracks[0].values.size(), 18u);
  Animated linear({0}, {0, 0, 0, 1}, "rotation");
  EXPECT_EQ(linear.rigged().animations[0].tracks[0].channel, Channel::rotation);
}

TEST(GltfAnimation, MistakesAreNamedWithTheirPlace) {
  EXPECT_EQ(Animated({0, 0}, {0, 0, 0, 4, 0, 0}, "translation").error(),
            "a.glb: /animations/0/samplers/0/input: time 1 is not after the one before");
  EXPECT_EQ(Animated({-1, 0}, {0, 0, 0, 4, 0, 0}, "translation").error(),
            "a.glb: /animations/0/samplers/0/input: time 0 is negative or not finite");
  EXPECT_EQ(Animated({0, 1}, {0, 0, 0}, "translation").error(),
            "a.glb: /animations/0/samplers/0/output: 1 values for 2 times");
  EXPECT_EQ(Animated({0}, {0, 0, 0, 0}, "rotation").error(),
            "a.glb: /animations/0/samplers/0/output: value 0 has no length");
  Animated wrong = shift();
  wrong.sampler["interpolation"] = "SMOOTH";
  EXPECT_EQ(wrong.error(),
            "a.glb: /animations/0/samplers/0/interpolation: unknown interpolation 'SMOOTH'");
  wrong = shift();
  wrong.channel["target"]["path"] = "color";
  EXPECT_EQ(wrong.error(), "a.glb: /animations/0/channels/0/target/path: unknown path 'color'");
  wrong = shift();
  wrong.channel["target"]["node"] = 2;
  EXPECT_NE(wrong.error().find("/animations/0/channels/0/target/node"), std::string::npos);
  wrong = shift();
  wrong.channel["sampler"] = 1;
  EXPECT_NE(wrong.error().find("/animations/0/channels/0/sampler"), std::string::npos);
}

TEST(GltfAnimation, WhatIsNotFollowedIsIgnored) {
  Animated nothing = shift();
  nothing.channel["target"].erase("node");
  EXPECT_TRUE(nothing.rigged().animations[0].tracks.empty());
}

TEST(GltfAnimation, AFileWithoutAnimationsGivesTheSameScene) {
  GltfFile file = one_triangle();
  file.root["nodes"] = {{{"mesh", 0}, {"rotation", {0, 0, 1, 1}}, {"scale", {1, 2, 3}}}};
  const RiggedScene rigged = read(file);
  EXPECT_TRUE(rigged.animations.empty());
  EXPECT_EQ(rigged.scene.instances[0].to_world, file.read().instances[0].to_world);
}

}  // namespace
}  // namespace strahl
