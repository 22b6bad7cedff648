// apps/strahl/render_frames_test.cpp - `strahl render --frames`: files, table, checks, refusals.
#include <apps/strahl/run_test.h>
#include <string>
#include <tests/support/shared.h>

#include <gtest/gtest.h>

namespace strahl::cli {
namespace {

using test::Finished;

class FramesCommand : public test::CommandTest {
 protected:
  void SetUp() override {
    folder_.write("move.json", R"({"tracks": [{"node": 0, "times": [0, 2],
        "translations": [[0, 0, 0], [0.5, 0, 0]]}]})");
  }
  const std::string small_ = "render gen:balls:1 --size 16x12 --mode normals --motion move.json ";
};

TEST_F(FramesCommand, WritesNumberedPictures) {
  const Finished finished = run(small_ + "--frames 3 -o out.png");
  ASSERT_EQ(finished.code, 0) << finished.err;
  for (const char* name : {"out_0000.png", "out_0001.png", "out_0002.png"})
    EXPECT_EQ(folder_.read(name).substr(1, 3), "PNG") << name;
  EXPECT_FALSE(folder_.read("out_0000.png") == folder_.read("out_0002.png"));
  EXPECT_NE(finished.out.find("update ms"), std::string::npos);
}

TEST_F(FramesCommand, PicturesAreTheSameForStructuresThatCannotMove) {
  ASSERT_EQ(run(small_ + "--frames 2 -o a.png").code, 0);
  ASSERT_EQ(run(small_ + "--frames 2 -o b.png --structure kd_tree").code, 0);
  EXPECT_TRUE(folder_.read("a_0001.png") == folder_.read("b_0001.png"));
}

TEST_F(FramesCommand, VerifiesEveryFrame) {
  const Finished finished = run(small_ + "--frames 5 --verify --json");
  ASSERT_EQ(finished.code, 0) << finished.err;
  const nlohmann::json json = finished.json();
  EXPECT_EQ(json["frames"].size(), 5u);
  EXPECT_EQ(json["frames"][4]["time"], 2.0);
  EXPECT_EQ(json["moving_instances"], 1);
  EXPECT_EQ(json["summary"]["differing_frames"], 0);
  EXPECT_GT(json["summary"]["checked_rays"], 5 * 5000);
  EXPECT_EQ(json["summary"]["brute_force_frames"], 5);
  for (const nlohmann::json& frame : json["frames"]) EXPECT_GT(frame["checked_hits"], 100);
}

TEST_F(FramesCommand, ARobotFollowsItsOwnAnimation) {
  STRAHL_REQUIRE_SHARED("scenes/franka_panda.glb");
  const auto robot = test::shared_dir() / "scenes/franka_panda.glb";
  const Finished finished =
      run("render '" + robot.string() + "' --frames 3 --verify --json --size 32x24 --mode normals");
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_EQ(finished.json()["summary"]["differing_frames"], 0);
  EXPECT_GE(finished.json()["moving_instances"], 7);
}

TEST_F(FramesCommand, WrongArgumentsAreRefused) {
  expect_error("render gen:balls:1 --frames 2 --json", 3, "no animation");
  expect_error("render gen:balls:1 --motion move.json --json", 2, "--frames");
  expect_error("render gen:balls:1 --frames 0 --json", 2, "--frames");
  expect_error("render gen:balls:1 --frames 2 --motion absent.json --json", 3, "absent.json");
  expect_error(small_ + "--frames 2", 2, "--output");
  folder_.write("flat.json", R"({"tracks": [{"node": 0, "times": [0, 1],
      "scales": [[1, 1, 1], [1, 0, 1]]}]})");
  expect_error("render gen:balls:1 --frames 2 --motion flat.json --json", 3, "node 0");
}

}  // namespace
}  // namespace strahl::cli
