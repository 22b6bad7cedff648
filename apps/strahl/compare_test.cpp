// apps/strahl/compare_test.cpp - `strahl compare`: results, resumption, refusals.
#include <apps/strahl/run_test.h>
#include <cstdlib>
#include <string>

namespace strahl::cli {
namespace {

using test::Finished;

class CompareCommand : public test::CommandTest {};

constexpr const char* kSmall =
    " --structures bvh,kd_tree:split=median,axis=round_robin,grid --workloads random,shadow"
    " --rays 500 --repeat 2 --maps 24x16 --json -o out";

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

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
      EXPECT_EQ(row["build"]["seconds_of_repeats"].size(), 2u);
      EXPECT_EQ(row["statistics"]["N_IN"].get<int>() + row["statistics"]["N_V"].get<int>(),
                row["build"]["nodes"]);
      EXPECT_EQ(row["statistics"]["N_OIV"], row["build"]["references"]);
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
  const std::string markdown = folder_.read("out/compare.md");
  EXPECT_NE(markdown.find("## gen:tetra:3"), std::string::npos);
  for (const char* name :
       {"N_TS", "N_ETS", "N_EETS", "N_IT", "N_BIT", "N_IN", "N_V", "N_EV", "N_OIV", "SAH", "EPO"}) {
    EXPECT_NE(csv.find(std::string(",") + name), std::string::npos) << name;
    EXPECT_NE(markdown.find(std::string("| ") + name + " |"), std::string::npos) << name;
  }
}

TEST_F(CompareCommand, RanksStructuresOverScenes) {
  const Finished finished = run("compare gen:balls:1 gen:tetra:3" + std::string(kSmall));
  ASSERT_EQ(finished.code, 0) << finished.err;
  const auto json = finished.json();
  for (const auto& workload : json["summary"]["workloads"]) {
    double ranks = 0.0;
    int wins = 0;
    for (const auto& structure : workload["structures"]) {
      ranks += structure["mean_rank"].get<double>(), wins += structure["wins"].get<int>();
      EXPECT_GE(structure["worst_to_best"], 1.0);
    }
    EXPECT_DOUBLE_EQ(ranks, 6.0);
    EXPECT_EQ(wins, 2);
    EXPECT_GT(workload["critical_difference"], 0.0);
  }
  EXPECT_NE(folder_.read("out/compare.md").find("## Ranks: shadow"), std::string::npos);
}

TEST_F(CompareCommand, PutsChartsAndHeatMapsIntoOnePage) {
  const Finished finished = run("compare gen:balls:1" + std::string(kSmall));
  ASSERT_EQ(finished.code, 0) << finished.err;
  const std::string page = folder_.read("out/compare.html");
  EXPECT_EQ(count(page, "<img class=\"map\""), 3u * 3u);
  EXPECT_EQ(count(page, "src=\"data:image/"), count(page, "<img "));  // nothing is elsewhere
  EXPECT_EQ(page.find("http"), std::string::npos);
  const bool has_gnuplot = std::system("gnuplot --version > /dev/null 2>&1") == 0;
  EXPECT_EQ(count(page, "<img class=\"chart\""), has_gnuplot ? 2u * 3u + 1u : 0u);
  EXPECT_NE(finished.json()["scenes"][0]["structures"][2]["maps"]["tests"], "");
}

TEST_F(CompareCommand, OneStructureWithoutMapsIsEnough) {
  const Finished finished =
      run("compare gen:balls:1 --structures bvh --workloads random --rays 200 --repeat 1"
          " --maps none --json -o out");
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_FALSE(finished.json()["scenes"][0]["structures"][0].contains("maps"));
  EXPECT_EQ(finished.json()["summary"]["workloads"][0]["structures"][0]["mean_rank"], 1.0);
}

TEST_F(CompareCommand, TellsTheOverlapOfTreesOfVolumesWhenAsked) {
  const std::string command = "compare gen:balls:1" + std::string(kSmall);
  const auto plain = run(command).json();
  EXPECT_TRUE(plain["scenes"][0]["structures"][0]["build"]["epo"].is_null());
  const auto asked = run(command + " --epo").json();
  EXPECT_GT(asked["scenes"][0]["structures"][0]["build"]["epo"], 0.0);
  EXPECT_TRUE(asked["scenes"][0]["structures"][2]["build"]["epo"].is_null());
  EXPECT_NE(folder_.read("out/compare.md").find("| SAH | EPO |"), std::string::npos);
  EXPECT_NE(folder_.read("out/compare.csv").find(",SAH,EPO,"), std::string::npos);
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
