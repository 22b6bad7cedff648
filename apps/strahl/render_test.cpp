// apps/strahl/render_test.cpp - `strahl render`: files, JSON, refusals.
#include <apps/strahl/run_test.h>
#include <string>

#include <gtest/gtest.h>

#include <strahl/io/exr.h>

namespace strahl::cli {
namespace {

using test::Finished;
using RenderCommand = test::CommandTest;

TEST_F(RenderCommand, EveryModeWritesAPicture) {
  for (const char* mode : {"shaded", "normals", "depth", "ao", "path", "cost", "steps", "tests"}) {
    const Finished finished =
        run(std::string("render gen:balls:2 -o out.png --size 40x30 --mode ") + mode);
    ASSERT_EQ(finished.code, 0) << finished.err;
    EXPECT_EQ(folder_.read("out.png").substr(1, 3), "PNG");
    EXPECT_EQ(finished.err, "") << "no progress bar without a terminal";
  }
}

TEST_F(RenderCommand, PictureIsTheSameForAnyThreadsAndStructure) {
  const std::string common = "render gen:balls:2 --size 50x40 ";
  ASSERT_EQ(run(common + "-o a.png --threads 1 --structure brute_force").code, 0);
  ASSERT_EQ(run(common + "-o b.png --threads 2").code, 0);
  EXPECT_TRUE(folder_.read("a.png") == folder_.read("b.png"));
}

TEST_F(RenderCommand, ExrHoldsDepthIdsAndNormals) {
  ASSERT_EQ(run("render gen:balls:2 --size 20x20 -o out.exr").code, 0);
  const Image image = read_exr(folder_ / "out.exr");
  EXPECT_EQ(image.width, 20);
  EXPECT_EQ(image.float_channels.size(), 4u);
  EXPECT_EQ(image.uint_channels.size(), 3u);
}

TEST_F(RenderCommand, CornersAreTheStandardTestImage) {
  const nlohmann::json json = run("render gen:tetra:3 --corners --mode depth --json").json();
  EXPECT_EQ(json["primary_rays"], 513 * 513);
  EXPECT_EQ(json["rays"], 513 * 513);
  EXPECT_GT(json["primary_hits"], 10000);
  EXPECT_EQ(json["hits"], json["primary_hits"]);
  EXPECT_EQ(json["width"], 513);
}

TEST_F(RenderCommand, ViewCanBeGiven) {
  const nlohmann::json json = run("render gen:balls:1 --json --mode normals --size 16x16 "
                                  "--from -1,-2,9 --at 0,0,0 --up 0,1,0 --fov 30")
                                  .json();
  EXPECT_EQ(json["view"]["from"], (nlohmann::json{-1.0, -2.0, 9.0}));
  EXPECT_EQ(json["view"]["fov"], 30.0);
  EXPECT_EQ(json["primary_hits"], json["primary_rays"]) << "the ground fills the picture";
}

TEST_F(RenderCommand, DrawsTheVolumesOfALevel) {
  const std::string common = "render gen:balls:2 --size 50x40 --structure ";
  ASSERT_EQ(run(common + "bvh -o plain.png").code, 0);
  ASSERT_EQ(run(common + "bvh:bv=obb -o obb.png --volumes 3 --threads 1").code, 0);
  ASSERT_EQ(run(common + "bvh:bv=obb -o again.png --volumes 3 --threads 2").code, 0);
  ASSERT_EQ(run(common + "bvh -o deeper.png --volumes 5").code, 0);
  EXPECT_TRUE(folder_.read("obb.png") == folder_.read("again.png"));
  EXPECT_FALSE(folder_.read("obb.png") == folder_.read("plain.png"));
  EXPECT_FALSE(folder_.read("deeper.png") == folder_.read("plain.png"));
  expect_error(common + "grid -o out.png --volumes 3", 2, "volumes");
  expect_error(common + "bvh -o out.png --volumes 3 --frames 2", 2, "--frames");
  expect_error(common + "bvh -o out.png --volumes 3 --corners", 2, "--corners");
}

TEST_F(RenderCommand, WrongArgumentsAreRefused) {
  const std::string common = "render gen:balls:1 ";
  expect_error(common, 2, "--output");
  expect_error(common + "-o out.jpg", 2, ".png or .exr");
  expect_error(common + "--json --mode pretty", 2, "pretty");
  expect_error(common + "--json --size 10by10", 2, "10by10");
  expect_error(common + "--json --from 1,2", 2, "1,2");
  expect_error(common + "--json --fov 200", 2, "200");
  expect_error(common + "--json --from 1,1,1 --at 1,1,1", 2, "camera");
  expect_error(common + "--json --spp 0", 2, "--spp");
  expect_error(common + "-o absent/out.png", 4, "absent");
  expect_error("render absent.ply -o out.png", 3, "absent.ply");
  expect_error(common + "--json --size 2000x2000 --memory 1M", 4, "image");
}

TEST_F(RenderCommand, EmptySceneGivesAPicture) {
  folder_.write("empty.off", "OFF\n0 0 0\n");
  EXPECT_EQ(run("render empty.off -o out.png --size 16x16").code, 0);
}

}  // namespace
}  // namespace strahl::cli
