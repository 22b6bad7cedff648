// apps/strahl/compare_test.cpp - `strahl compare`: results, resumption, refusals.
#include <apps/strahl/run_test.h>
#include <string>

namespace strahl::cli {
namespace {

using test::Finished;

class CompareCommand : public test::CommandTest {};

constexpr const char* kSmall =
    " --structures bvh,kd_tree:split=median,axis=round_robin,grid --workloads random,shadow"
    " --rays 500 --repeat 2 --json -o out";

TEST_F(CompareCommand, WritesTheSameResultsAsJsonCsvAndMarkdown) {
  const Finished finished = run("compare gen:balls:1 gen:tetra:3" + std::string(kSmall));
  ASSERT_EQ(finished.code, 0) << finished.err;
  const auto json = finished.json();
  EXPECT_EQ(json, nlohmann::json::parse(folder_.read("out/compare.json")));
  ASSERT_EQ(json["scenes"].size(), 2u);
  for (const auto& scene : json["scenes"]) {
    EXPECT_EQ(scene["structures"].size(), 3u);
    for (const auto& row : scene["structures"]) {
      EXPECT_GT(row["build"]["bytes"], 0);
      ASSERT_EQ(row["workloads"].size(), 2u);
      for (const auto& cell : row["workloads"]) {
        EXPECT_GT(cell["mrays"], 0.0);
        EXPECT_GT(cell["per_ray"]["N_IT"], 0.0);
        EXPECT_EQ(cell["seconds"].size(), 2u);
      }
    }
    EXPECT_EQ(scene["structures"][0]["workloads"][0]["time_to_first"], (std::vector{1, 1, 1}));
  }
  const std::string csv = folder_.read("out/compare.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 3 * 2);
  EXPECT_NE(csv.find("\"kd_tree:split=median,axis=round_robin\",random"), std::string::npos);
  EXPECT_NE(folder_.read("out/compare.md").find("## gen:tetra:3"), std::string::npos);
}

TEST_F(CompareCommand, GoesOnWhereItWasUnlessSomethingElseIsAsked) {
  const std::string command = "compare gen:balls:1" + std::string(kSmall);
  const Finished first = run(command), again = run(command), other = run(command + " --seed 2");
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_EQ(first.out, again.out);  // times, too: nothing was measured again
  EXPECT_NE(other.out, first.out);
}

TEST_F(CompareCommand, ADamagedPartIsMeasuredAgain) {
  const std::string command = "compare gen:balls:1" + std::string(kSmall);
  ASSERT_EQ(run(command).code, 0);
  ASSERT_EQ(run("query gen:balls:1 --help").code, 0);
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out/parts"))
    folder_.write("out/parts/" + entry.path().filename().string(), "{\"scene\": ");
  const Finished again = run(command);
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(again.json()["scenes"][0]["structures"].size(), 3u);
}

TEST_F(CompareCommand, RefusesWhatItCannotCompare) {
  expect_error("compare gen:balls:1 --structures nothing -o out", 2, "nothing");
  expect_error("compare gen:balls:1 --workloads primry -o out", 2, "primary shadow");
  expect_error("compare gen:balls:1 --structures bvh", 2, "-o");
  expect_error("compare missing.ply --structures bvh -o out", 3, "missing.ply");
}

}  // namespace
}  // namespace strahl::cli
