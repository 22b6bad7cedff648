// apps/strahl/advise_test.cpp - `strahl advise`, and `auto` where a structure is named.
#include <apps/strahl/run_test.h>
#include <string>

namespace strahl::cli {
namespace {

using test::Finished;

class AdviseCommand : public test::CommandTest {};

TEST_F(AdviseCommand, NamesTheFastestAndTheSmallest) {
  const Finished finished = run("advise gen:balls:2 --workload shadow --rays 1e7 --json");
  ASSERT_EQ(finished.code, 0) << finished.err;
  const auto json = finished.json();
  EXPECT_EQ(json["fastest"], json["predictions"][0]["spec"]);
  EXPECT_EQ(json["smallest"], "brute_force");
  EXPECT_EQ(json["rays"], 1e7);
  EXPECT_EQ(json["workload"], "shadow");
}

TEST_F(AdviseCommand, PrintsATable) {
  const Finished finished = run("advise gen:tetra:4 --structures grid,bvh:leaf_size=2 --rays 1000");
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_NE(finished.out.find("bvh:leaf_size=2 "), std::string::npos) << finished.out;
  EXPECT_NE(finished.out.find("fastest for 1000 rays (random): "), std::string::npos);
}

TEST_F(AdviseCommand, RefusesWhatMakesNoSense) {
  expect_error("advise gen:balls:1 --structures no_such", 2, "no_such");
  expect_error("advise gen:balls:1 --rays=-1", 2, "rays");
  expect_error("advise gen:balls:1 --workload dreams", 2, "dreams");
  expect_error("advise no_such.ply", 3, "no_such.ply");
}

TEST_F(AdviseCommand, AutoAnswersWithTheSameBitsEverywhere) {
  write_rays("rays.npy", 100);
  const Finished chosen = run("query gen:balls:2 --rays rays.npy --structure auto --json");
  const Finished brute = run("query gen:balls:2 --rays rays.npy --structure brute_force --json");
  ASSERT_EQ(chosen.code, 0) << chosen.err;
  EXPECT_EQ(chosen.json()["result_hash"], brute.json()["result_hash"]);
  EXPECT_NE(chosen.json()["structure"], "auto");
  EXPECT_NE(chosen.err.find("strahl: auto: "), std::string::npos) << chosen.err;
  for (const char* command :
       {"info gen:balls:2 --structure auto",
        "render gen:balls:2 --size 8x8 --structure auto -o auto.png",
        "compare gen:balls:2 --structures auto,brute_force --rays 100 --repeat 1 -o out"})
    EXPECT_EQ(run(command).code, 0) << command;
}

}  // namespace
}  // namespace strahl::cli
