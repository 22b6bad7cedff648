// io/motion_test.cpp - sampling of tracks, poses of a rig, motions from JSON.
#include <cmath>
#include <numbers>
#include <tests/support/memory_file.h>

#include <gtest/gtest.h>

#include <strahl/io/motion_file.h>

namespace strahl {
namespace {

using test::error_of;
using test::memory_file;

constexpr double kHalf = 0.70710678118654752;

Track track(Channel channel, Interpolation interpolation, std::vector<double> times,
            std::vector<double> values) {
  Track made;
  made.channel = channel, made.interpolation = interpolation;
  made.times = std::move(times), made.values = std::move(values);
  return made;
}

void expect_near(const std::array<double, 4>& got, const std::array<double, 4>& expected) {
  for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(got[c], expected[c], 1e-14) << c;
}

TEST(Track, EndValuesHoldOutsideTheTimes) {
  const Track t = track(Channel::translation, Interpolation::linear, {1, 3}, {1, 2, 3, 5, 6, 7});
  EXPECT_EQ(t.at(0.0), (std::array<double, 4>{1, 2, 3, 0}));
  EXPECT_EQ(t.at(9.0), (std::array<double, 4>{5, 6, 7, 0}));
  EXPECT_EQ(t.at(2.0), (std::array<double, 4>{3, 4, 5, 0}));
}

TEST(Track, StepsChangeAtTheirTime) {
  const Track t =
      track(Channel::scale, Interpolation::step, {0, 1, 2}, {1, 1, 1, 2, 2, 2, 3, 3, 3});
  EXPECT_EQ(t.at(0.999)[0], 1.0);
  EXPECT_EQ(t.at(1.0)[0], 2.0);
  EXPECT_EQ(t.at(1.5)[0], 2.0);
  EXPECT_EQ(t.at(2.0)[0], 3.0);
}

TEST(Track, RotationsTakeTheShorterArc) {
  // From no rotation to a quarter turn about z, given with the opposite sign and another length.
  const Track t = track(Channel::rotation, Interpolation::linear, {0, 1},
                        {0, 0, 0, 2, 0, 0, -3 * kHalf, -3 * kHalf});
  const double angle = std::numbers::pi / 12;  // half of a third of a quarter turn
  expect_near(t.at(1.0 / 3), {0, 0, std::sin(angle), std::cos(angle)});
  expect_near(t.at(0.0), {0, 0, 0, 1});
}

TEST(Track, CubicSplinesPassKeysWithTheirTangents) {
  // Per key: tangent in, value, tangent out; 2 seconds apart. x(t) = t^3 has tangents 0 and 12.
  const Track t = track(Channel::translation, Interpolation::cubic_spline, {0, 2},
                        {9, 9, 9, 0, 0, 0, 0, 1, 0, 12, 1, 0, 8, 2, 0, 9, 9, 9});
  for (const double s : {0.0, 0.5, 1.0, 1.7, 2.0}) {
    EXPECT_NEAR(t.at(s)[0], s * s * s, 1e-14);
    EXPECT_NEAR(t.at(s)[1], s, 1e-14);
  }
  EXPECT_EQ(t.at(5.0)[0], 8.0);
}

TEST(Track, CubicRotationsHaveUnitLength) {
  const Track t = track(Channel::rotation, Interpolation::cubic_spline, {0, 1},
                        {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0});
  const auto v = t.at(0.5);
  expect_near(v, {0, 0, kHalf, kHalf});
}

/// root -> arm -> hand, one instance on root and hand each, the latter with a copy of its own.
Rig arm() {
  Rig rig;
  rig.nodes = {{"root", RigNode::kNoParent, {}}, {"arm", 0, {}}, {"hand", 1, {}}};
  rig.nodes[1].rest.translation = {1, 0, 0};
  rig.nodes[2].rest.translation = {1, 0, 0};
  rig.order = {0, 1, 2};
  rig.mounts = {Mount{0, {}}, Mount{2, Affine::translation({0, 0, 5})}, std::nullopt};
  return rig;
}

std::vector<Affine> rest() {
  return {Affine{}, Affine::translation({2, 0, 5}), Affine::scaling({3, 3, 3})};
}

Motion motion_of(const std::string& json, const Rig& rig = arm()) {
  return read_motion(memory_file(json, "m.json"), rig);
}
std::string refusal(const std::string& tracks) {
  return error_of([&] { motion_of("{\"tracks\": [" + tracks + "]}"); });
}

TEST(Poser, JointsTurnAllThatHangsBelow) {
  const Poser poser(arm(), motion_of(R"({"tracks": [{"node": "arm", "axis": [0, 0, 2],
      "times": [0, 2], "degrees": [0, 180]}]})"),
                    rest());
  EXPECT_EQ(poser.moving(), 1u);
  EXPECT_EQ(poser.duration(), 2.0);
  const auto half = poser.at(1.0);
  EXPECT_EQ(half[0], rest()[0]);
  EXPECT_EQ(half[2], rest()[2]) << "no mount: stays";
  const Vec3d hand = half[1].point({0, 0, 0});  // the arm now points along y
  EXPECT_NEAR(hand.x, 1.0, 1e-15);
  EXPECT_NEAR(hand.y, 1.0, 1e-15);
  EXPECT_NEAR(hand.z, 5.0, 1e-15);
}

TEST(Poser, RestIsKeptToTheBit) {
  const Poser poser(arm(), motion_of(R"({"tracks": [{"node": 2, "times": [0],
      "translations": [[1, 0, 0]]}]})"),
                    rest());
  EXPECT_EQ(poser.at(3.0), rest());
}

TEST(Poser, AnAngleTurnsWhatOtherChannelsGive) {
  const Poser poser(arm(), motion_of(R"({"tracks": [{"node": "hand", "axis": [0, 0, 1],
      "times": [0], "radians": [1.5707963267948966], "scales": [[2, 1, 1]],
      "rotations": [[1, 0, 0, 0]]}]})"),
                    rest());
  // Scale x by 2, turn x to y, then half a turn about x: x -> (0, -2, 0).
  const Vec3d x = poser.at(0.0)[1].vector({1, 0, 0});
  EXPECT_NEAR(x.x, 0.0, 1e-15);
  EXPECT_NEAR(x.y, -2.0, 1e-15);
}

TEST(Poser, AMatrixCanBeTurnedAndShiftedOnly) {
  Rig rig = arm();
  rig.nodes[1].rest.matrix = Affine::scaling({2, 2, 2});
  const Poser poser(rig,
                    motion_of(R"({"tracks": [{"node": "arm", "times": [0],
      "translations": [[7, 0, 0]], "axis": [0, 0, 1], "degrees": [90]}]})",
                              rig),
                    rest());
  const Vec3d hand = poser.at(0.0)[1].point({0, 0, -5});
  EXPECT_NEAR(hand.x, 7.0, 1e-15);
  EXPECT_NEAR(hand.y, 2.0, 1e-15);
  const Motion scaling =
      motion_of(R"({"tracks": [{"node": "arm", "times": [0], "scales": [[1, 1, 1]]}]})", rig);
  EXPECT_EQ(
      error_of([&] { Poser(rig, scaling, rest()); }),
      "m.json: node 1 'arm': it is placed by a matrix, which has no rotation and scale to move");
}

TEST(Poser, ImpossiblePosesNameNodeAndTime) {
  const Poser poser(arm(), motion_of(R"({"tracks": [{"node": "hand", "times": [0, 1],
      "scales": [[1, 1, 1], [1, 0, 1]]}]})"),
                    rest());
  EXPECT_EQ(error_of([&] { poser.at(0.5); }), "no error");
  EXPECT_EQ(error_of([&] { poser.at(1.0); }),
            "m.json: node 2 'hand': at 1.000000 s its transformation is singular or nearly so "
            "(condition above 2^30)");
}

TEST(Poser, AChannelIsMovedOnce) {
  const Motion twice = motion_of(R"({"tracks": [
      {"node": 1, "times": [0], "translations": [[0, 0, 0]]},
      {"node": "arm", "times": [1], "translations": [[0, 0, 0]]}]})");
  EXPECT_EQ(error_of([&] { Poser(arm(), twice, rest()); }),
            "m.json: node 1 'arm': two tracks move the same channel of it");
}

TEST(MotionFile, DurationIsTheLastTimeUnlessGiven) {
  const std::string track = R"({"node": 0, "times": [0, 7], "translations": [[0,0,0],[1,0,0]]})";
  EXPECT_EQ(motion_of("{\"tracks\": [" + track + "]}").duration, 7.0);
  EXPECT_EQ(motion_of("{\"duration\": 2, \"tracks\": [" + track + "]}").duration, 2.0);
  EXPECT_EQ(motion_of("{\"tracks\": []}").tracks.size(), 0u);
}

TEST(MotionFile, MistakesAreNamedWithTheirPlace) {
  EXPECT_EQ(refusal(R"({"node": "leg", "times": [0], "scales": [[1,1,1]]})"),
            "m.json: /tracks/0/node: the scene has no node of this name");
  EXPECT_EQ(refusal(R"({"node": 3, "times": [0], "scales": [[1,1,1]]})"),
            "m.json: /tracks/0/node: index 3 into a list of 3 nodes");
  EXPECT_EQ(refusal(R"({"node": 0, "times": [0, 1, 1], "scales": []})"),
            "m.json: /tracks/0/times/2: must be after the time before");
  EXPECT_EQ(refusal(R"({"node": 0, "times": [-1], "scales": [[1,1,1]]})"),
            "m.json: /tracks/0/times/0: must not be negative");
  EXPECT_EQ(refusal(R"({"node": 0, "times": [], "scales": []})"),
            "m.json: /tracks/0/times: must not be empty");
  EXPECT_EQ(refusal(R"({"node": 0, "times": [0], "scales": [[1,1,1], [1,1,1]]})"),
            "m.json: /tracks/0/scales: 2 values for 1 times");
  EXPECT_EQ(refusal(R"({"node": 0, "times": [0], "scales": [[1,1]]})"),
            "m.json: /tracks/0/scales/0: must hold 3 numbers");
  EXPECT_EQ(refusal(R"({"node": 0, "times": [0], "rotations": [[0,0,0,0]]})"),
            "m.json: /tracks/0/rotations/0: must have a length");
  EXPECT_EQ(refusal(R"({"node": 0, "times": [0], "degrees": [1]})"),
            "m.json: /tracks/0: 'axis' is missing");
  EXPECT_EQ(refusal(R"({"node": 0, "times": [0], "axis": [0,0,0], "degrees": [1]})"),
            "m.json: /tracks/0/axis: must have a length");
  EXPECT_EQ(refusal(R"({"node": 0, "times": [0], "axis": [0,0,1]})"),
            "m.json: /tracks/0/axis: an axis needs degrees or radians");
  EXPECT_EQ(refusal(R"({"node": 0, "times": [0]})"),
            "m.json: /tracks/0: moves nothing: needs translations, rotations, scales, degrees or "
            "radians");
  EXPECT_EQ(refusal(R"({"node": 0, "times": [0], "scale": [[1,1,1]]})").substr(0, 48),
            "m.json: /tracks/0: unknown member 'scale'; known");
  EXPECT_EQ(refusal(R"({"node": 0, "times": [0], "interpolation": "cubic", "scales": [[1,1,1]]})"),
            "m.json: /tracks/0/interpolation: must be linear or step");
}

TEST(MotionFile, ANameOfTwoNodesIsNoName) {
  Rig rig = arm();
  rig.nodes[2].name = "arm";
  EXPECT_EQ(error_of([&] {
              motion_of(R"({"tracks": [{"node": "arm", "times": [0], "scales": [[1,1,1]]}]})", rig);
            }),
            "m.json: /tracks/0/node: nodes 1 and 2 both have this name; give the number");
}

}  // namespace
}  // namespace strahl
