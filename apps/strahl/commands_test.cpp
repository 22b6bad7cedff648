// apps/strahl/commands_test.cpp - exit codes, messages and JSON of list, info, check, generate.
#include <apps/strahl/arguments.h>
#include <apps/strahl/progress.h>
#include <apps/strahl/run_test.h>
#include <string>
#include <tests/support/shared.h>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>

namespace strahl::cli {
namespace {

using test::Finished;
using Commands = test::CommandTest;

constexpr const char* kSquare = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";

TEST_F(Commands, HelpOfEverySubcommandHasExamples) {
  for (const char* name : {"", "list", "info", "check", "render", "query", "generate"}) {
    const Finished finished = run(std::string(name) + " --help");
    EXPECT_EQ(finished.code, 0) << name;
    EXPECT_NE(finished.out.find("Examples:\n  strahl "), std::string::npos) << name;
  }
}

TEST_F(Commands, WrongArgumentsAreUsageErrors) {
  EXPECT_EQ(run("").code, 2);
  expect_error("unknown", 2, "unknown");
  expect_error("info", 2, "scene");
  expect_error("info gen:balls:1 --no-such-option", 2, "no-such-option");
  expect_error("info gen:balls:1 --threads 0", 2, "--threads");
  expect_error("info gen:balls:1 --memory 3X", 2, "3X");
  expect_error("info gen:nothing:1", 2, "nothing");
  expect_error("info gen:balls:1 --structure no_such", 2, "no_such");
  expect_error("info gen:balls:1 --structure kd_tree:split=x", 2, "split");
}

TEST_F(Commands, VersionNamesWhatItIsMadeOf) {
  EXPECT_EQ(run("--version").out.rfind("strahl ", 0), 0u);
  const std::string text = run("--version --verbose").out;
  for (const char* word : {"commit", "isa", "threads", "oneTBB", "CLI11"})
    EXPECT_NE(text.find(word), std::string::npos) << word;
}

TEST_F(Commands, ListHasEveryStructureWithItsOptions) {
  const nlohmann::json json = run("list --json").json();
  ASSERT_EQ(json["structures"].size(), all_structures().size());
  for (const auto& structure : json["structures"]) {
    EXPECT_TRUE(structure["name"].is_string());
    for (const auto& option : structure["options"])
      for (const char* key : {"name", "type", "default", "range", "values", "help"})
        EXPECT_TRUE(option.contains(key)) << option;
  }
  EXPECT_GE(json["generators"].size(), 17u);
  EXPECT_NE(run("list").out.find("gen:NAME"), std::string::npos);
}

TEST_F(Commands, InfoCountsTheSceneAndChecksTheStructure) {
  const nlohmann::json json = run("info gen:balls:2 --structure bvh --json").json();
  EXPECT_EQ(json["spheres"], 91);
  EXPECT_EQ(json["triangles"], 2);
  EXPECT_EQ(json["structure"]["spec"], "bvh");
  EXPECT_EQ(json["structure"]["valid"], true);
  EXPECT_EQ(json["structure"]["references"], 93);
  EXPECT_EQ(json["scene_hash"].get<std::string>().size(), 16u);
  EXPECT_EQ(
      run("info gen:balls:2 --structure bvh --threads 1 --json").json()["structure"]["tree_hash"],
      json["structure"]["tree_hash"]);
}

TEST_F(Commands, InfoPrintsTheOverlapOfTreesOfVolumesWhenAsked) {
  const auto structure = [&](const std::string& rest) {
    return run("info gen:balls:2 --json --structure " + rest).json()["structure"];
  };
  EXPECT_FALSE(structure("bvh").contains("epo"));
  const nlohmann::json two = structure("bvh --epo --threads 2")["epo"];
  EXPECT_GT(two, 0.0);
  EXPECT_EQ(structure("bvh --epo --threads 1")["epo"], two);
  for (const std::string spec : {"bvh:bv=sphere", "bvh:bv=auto", "two_level"})
    EXPECT_GT(structure(spec + " --epo")["epo"], 0.0) << spec;
  EXPECT_TRUE(structure("grid --epo")["epo"].is_null());
  EXPECT_NE(run("info gen:balls:2 --structure grid --epo").out.find("structure.epo "),
            std::string::npos);
  expect_error("info gen:balls:2 --epo", 2, "--structure");
}

TEST_F(Commands, UnreadableScenesAreBadInput) {
  expect_error("info absent.ply", 3, "absent.ply");
  expect_error("info scene.xyz", 3, "scene.xyz");
  folder_.write("broken.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 zero 0\n3 0 1 2\n");
  expect_error("info broken.off", 3, "line 5");
}

TEST_F(Commands, EmptySceneIsFineWithAWarning) {
  folder_.write("empty.off", "OFF\n0 0 0\n");
  const Finished finished = run("info empty.off --structure bvh --json");
  EXPECT_EQ(finished.code, 0);
  EXPECT_NE(finished.err.find("strahl: warning: "), std::string::npos);
  EXPECT_TRUE(finished.json()["bounds"].is_null());
  EXPECT_EQ(run("info empty.off --quiet").err, "");
  EXPECT_EQ(run("check empty.off").code, 0);
}

TEST_F(Commands, MemoryLimitIsAResourceError) {
  expect_error("info gen:balls:3 --structure bvh --memory 1K", 4, "memory limit");
}

TEST_F(Commands, ResultsThatCannotBePrintedAreAResourceError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_EQ(std::system((std::string(STRAHL_CLI_PATH) + " list > /dev/full 2> /dev/null").c_str()),
            4 << 8);
}

TEST_F(Commands, CheckExitsWithOneOnFindings) {
  EXPECT_EQ(run("check gen:icosphere:2").code, 0);
  folder_.write("square.off", kSquare);
  const Finished finished = run("check square.off --json");
  EXPECT_EQ(finished.code, 1);
  const nlohmann::json json = finished.json();
  EXPECT_EQ(json["ok"], false);
  const auto& finding = json["geometries"][0]["findings"][0];
  EXPECT_EQ(finding["defect"], "open_edge");
  EXPECT_EQ(finding["count"], 4);
  EXPECT_EQ(finding["first"], (nlohmann::json{0, 0, 1, 1}));
  EXPECT_NE(run("check square.off").out.find("open_edge"), std::string::npos);
}

TEST_F(Commands, GeneratedFileIsTheGeneratedScene) {
  ASSERT_EQ(run("generate balls --size 2 -o balls.nff").code, 0);
  EXPECT_EQ(run("info balls.nff --json").json()["scene_hash"],
            run("info gen:balls:2 --json").json()["scene_hash"]);
  ASSERT_EQ(run("generate soup --size 50 --seed 7 -o soup.ply").code, 0);
  EXPECT_EQ(run("info soup.ply --json").json()["scene_hash"],
            run("info gen:soup:50,seed=7 --json").json()["scene_hash"]);
  expect_error("generate balls -o balls.obj", 2, ".obj");
  expect_error("generate balls:2 --size 3 -o balls.nff", 2, "--size");
}

TEST_F(Commands, RealScenesHaveTheirCounts) {
  STRAHL_REQUIRE_SHARED("scenes/autzen_trim_spheres.ply");
  const std::string scenes = (test::shared_dir() / "scenes").string();
  EXPECT_EQ(run("info " + scenes + "/autzen_trim_spheres.ply --json").json()["spheres"], 110000);
  EXPECT_EQ(run("info " + scenes + "/RobotExpressive.glb --json").json()["triangles"], 3234);
  EXPECT_EQ(run("check " + scenes + "/extruder-body.stl").code, 0);
}

TEST(Arguments, AmountsOfMemoryHaveSuffixes) {
  EXPECT_EQ(parse_bytes("0", "--memory"), 0u);
  EXPECT_EQ(parse_bytes("123", "--memory"), 123u);
  EXPECT_EQ(parse_bytes("2K", "--memory"), 2048u);
  EXPECT_EQ(parse_bytes("3m", "--memory"), 3u << 20);
  EXPECT_EQ(parse_bytes("4G", "--memory"), std::uint64_t{4} << 30);
  for (const char* text : {"", "K", "-1", "1.5G", "1KB", " 1", "99999999999G"})
    EXPECT_THROW(parse_bytes(text, "--memory"), Error) << text;
}

TEST(Arguments, VectorsAndSizesAreReadWholly) {
  EXPECT_EQ(parse_vector("1,-2.5,3e2", "--from"), (Vec3d{1, -2.5, 300}));
  for (const char* text : {"", "1,2", "1,2,3,4", "1,,3", "a,b,c", "1,2,inf", "1 ,2,3"})
    EXPECT_THROW(parse_vector(text, "--from"), Error) << text;
  EXPECT_EQ(parse_image_size("640x480", "--size").height, 480);
  for (const char* text : {"", "640", "640x", "0x5", "-1x5", "640x480x2", "40000x1"})
    EXPECT_THROW(parse_image_size(text, "--size"), Error) << text;
}

TEST(Progress, LineShowsStageShareAndTimeLeft) {
  EXPECT_EQ(progress_line(0.5, "tracing", 65.0),
            "tracing    [###############...............]  50 %  eta 1:05");
  EXPECT_EQ(progress_line(1.0, "tracing", 1.0),
            "tracing    [##############################] 100 %");
}

}  // namespace
}  // namespace strahl::cli
