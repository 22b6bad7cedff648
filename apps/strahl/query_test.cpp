// apps/strahl/query_test.cpp - `strahl query`: formats, equal bytes, refusals, Ctrl-C.
#include <algorithm>
#include <apps/strahl/run_test.h>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/catalog/catalog.h>
#include <strahl/io/load.h>
#include <strahl/io/ray_file.h>

namespace strahl::cli {
namespace {

using test::Finished;

class QueryCommand : public test::CommandTest {
 protected:
  QueryCommand() { write_rays("rays.npy", 3000); }

  /// One array of an NPZ file, found by the entry's local header, which must hold its size.
  template <class T>
  std::vector<T> array(const std::string& file, const std::string& name) const {
    constexpr std::size_t kSizeAt = 22, kNameAt = 30;
    const std::string bytes = folder_.read(file);
    std::size_t at = bytes.find(name + ".npy");
    while (at != std::string::npos && bytes.compare(at - kNameAt, 4, "PK\3\4") != 0)
      at = bytes.find(name + ".npy", at + 1);
    if (at == std::string::npos) {
      ADD_FAILURE() << "no array " << name;
      return {};
    }
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data() + at - kNameAt + kSizeAt, sizeof size);
    folder_.write("entry.npy", bytes.substr(bytes.find("\x93NUMPY", at), size));
    const NpyView view(folder_ / "entry.npy");
    const std::span<const T> values = view.as<T>();
    return {values.begin(), values.end()};
  }
};

TEST_F(QueryCommand, EveryStructureAndThreadCountWritesTheSameBytes) {
  for (const char* query : {"closest", "any", "all", "count", "inside"}) {
    const std::string common =
        std::string("query gen:balls:2 --rays rays.npy --json --query ") + query;
    const Finished first = run(common + " --structure brute_force --threads 1 -o first.npz");
    ASSERT_EQ(first.code, 0) << first.err;
    const std::string expected = folder_.read("first.npz");
    EXPECT_GT(first.json()["hits"], 100) << query;
    for (const StructureEntry& entry : all_structures()) {
      for (const char* threads : {" --threads 1", " --threads 2"}) {
        const Finished other =
            run(common + " --structure " + entry.name + threads + " -o other.npz");
        EXPECT_EQ(other.json()["result_hash"], first.json()["result_hash"]);
        EXPECT_TRUE(folder_.read("other.npz") == expected) << query << entry.name << threads;
      }
    }
  }
}

TEST_F(QueryCommand, MissesHaveTheirFixedValues) {
  write_npy(folder_ / "two.npy", npy_array(std::vector<float>{0, 0, 9, 0, 0, -1,  //
                                                              0, 0, 9, 0, 0, 1},
                                           6));
  ASSERT_EQ(run("query gen:icosphere:1 --rays two.npy -o out.npz").code, 0);
  const auto t = array<double>("out.npz", "t_hit");
  const auto ids = array<std::uint32_t>("out.npz", "primitive_ids");
  const auto normals = array<double>("out.npz", "primitive_normals");
  ASSERT_EQ(t.size(), 2u);
  EXPECT_NEAR(t[0], 8.0, 0.2);
  EXPECT_EQ(t[1], std::numeric_limits<double>::infinity());
  EXPECT_EQ(ids[1], 4294967295u);
  EXPECT_EQ(array<std::uint32_t>("out.npz", "face_ids")[1], 4294967295u);
  ASSERT_EQ(normals.size(), 6u);
  EXPECT_GT(normals[2], 0.9);
  EXPECT_EQ(normals[5], 0.0);
  EXPECT_EQ(array<double>("out.npz", "primitive_uvs").size(), 4u);
}

TEST_F(QueryCommand, AllListsWhatCountCounts) {
  ASSERT_EQ(run("query gen:balls:2 --rays rays.npy --query all -o all.npz").code, 0);
  ASSERT_EQ(run("query gen:balls:2 --rays rays.npy --query count -o count.npz").code, 0);
  const auto splits = array<std::int64_t>("all.npz", "ray_splits");
  const auto counts = array<std::uint32_t>("count.npz", "counts");
  const auto rays = array<std::uint32_t>("all.npz", "ray_ids");
  const auto t = array<double>("all.npz", "t_hit");
  ASSERT_EQ(splits.size(), counts.size() + 1);
  ASSERT_EQ(t.size(), static_cast<std::size_t>(splits.back()));
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto first = static_cast<std::size_t>(splits[i]);
    const auto last = static_cast<std::size_t>(splits[i + 1]);
    ASSERT_EQ(last - first, counts[i]);
    EXPECT_TRUE(std::is_sorted(t.data() + first, t.data() + last));
    for (std::size_t k = first; k < last; ++k) ASSERT_EQ(rays[k], i);
  }
}

TEST_F(QueryCommand, ManyRaysAreAnsweredAsInOneBatch) {
  write_rays("many.npy", 70000);  // more than are traced in one call
  const RayFile file({folder_ / "many.npy", {}, {}, {}});
  RayFile::Chunk whole;
  file.load(0, file.size(), whole);
  std::vector<Hit> hits(file.size());
  build(std::make_shared<const Scene>(load_scene_data("gen:balls:2")), kDefaultSpec)
      ->closest_hit(whole.rays, hits);

  ASSERT_EQ(run("query gen:balls:2 --rays many.npy -o closest.npz").code, 0);
  ASSERT_EQ(run("query gen:balls:2 --rays many.npy --query all -o all.npz").code, 0);
  ASSERT_EQ(run("query gen:balls:2 --rays many.npy --query any -o any.npz").code, 0);
  const auto t = array<double>("closest.npz", "t_hit");
  const auto ids = array<std::uint32_t>("closest.npz", "primitive_ids");
  const auto all_t = array<double>("all.npz", "t_hit");
  const auto splits = array<std::int64_t>("all.npz", "ray_splits");
  const auto occluded = array<std::uint8_t>("any.npz", "occluded");
  for (std::size_t i = 0; i < hits.size(); ++i) {
    ASSERT_EQ(t[i], hits[i].t) << i;
    ASSERT_EQ(ids[i], hits[i].id.prim) << i;
    ASSERT_EQ(occluded[i] != 0, hits[i].is_hit()) << i;
    ASSERT_EQ(splits[i + 1] > splits[i], hits[i].is_hit()) << i;
    if (hits[i].is_hit()) {
      ASSERT_EQ(all_t[static_cast<std::size_t>(splits[i])], hits[i].t) << i;
    }
  }
}

TEST_F(QueryCommand, MasksSelectGeometriesAndExclusionsPrimitives) {
  // Geometry 0 of balls is the ground square, geometry 1 the spheres.
  write_npy(folder_ / "down.npy", npy_array(std::vector<double>{0.1, 0.2, 9, 0, 0, -1}, 6));
  write_npy(folder_ / "mask.npy", npy_array(std::vector<std::uint32_t>{1}));
  const std::string down = "query gen:balls:1 --rays down.npy -o out.npz ";
  ASSERT_EQ(run(down).code, 0);
  EXPECT_EQ(array<std::uint32_t>("out.npz", "geometry_ids")[0], 1u);
  const std::uint32_t sphere = array<std::uint32_t>("out.npz", "primitive_ids")[0];
  const double t = array<double>("out.npz", "t_hit")[0];

  ASSERT_EQ(run(down + "--mask mask.npy").code, 0);
  EXPECT_EQ(array<std::uint32_t>("out.npz", "geometry_ids")[0], 0u);

  write_npy(folder_ / "ids.npy", npy_array(std::vector<std::uint32_t>{0, 1, sphere}, 3));
  ASSERT_EQ(run(down + "--exclude ids.npy").code, 0);
  EXPECT_EQ(array<std::uint32_t>("out.npz", "geometry_ids")[0], 0u);

  write_npy(folder_ / "cursor.npy", npy_array(std::vector<double>{t, 0, 1, double(sphere)}, 4));
  ASSERT_EQ(run(down + "--after cursor.npy").code, 0);
  EXPECT_GT(array<double>("out.npz", "t_hit")[0], t);
}

TEST_F(QueryCommand, CullingSeesFrontSidesOnly) {
  write_npy(folder_ / "out.npy", npy_array(std::vector<double>{0, 0, 0, 0.1, 0.2, 1}, 6));
  const std::string from_inside = "query gen:icosphere:1 --rays out.npy --json ";
  EXPECT_EQ(run(from_inside).json()["hits"], 1);
  EXPECT_EQ(run(from_inside + "--cull").json()["hits"], 0);
  EXPECT_EQ(run(from_inside + "--query inside").json()["hits"], 1);
}

TEST_F(QueryCommand, NoRaysGiveEmptyArrays) {
  write_rays("none.npy", 0);
  for (const char* query : {"closest", "any", "all", "count", "inside"}) {
    const Finished finished =
        run(std::string("query gen:balls:1 --rays none.npy -o out.npz --json --query ") + query);
    ASSERT_EQ(finished.code, 0) << finished.err;
    EXPECT_EQ(finished.json()["rays"], 0);
  }
  EXPECT_EQ(array<std::int8_t>("out.npz", "inside").size(), 0u);
}

TEST_F(QueryCommand, InvalidRaysAreCounted) {
  write_npy(folder_ / "bad.npy", npy_array(std::vector<float>{0, 0, 9, 0, 0, 0}, 6));
  const Finished finished = run("query gen:balls:1 --rays bad.npy --json");
  EXPECT_EQ(finished.code, 0);
  EXPECT_EQ(finished.json()["invalid_rays"], 1);
  EXPECT_NE(finished.err.find("1 invalid rays"), std::string::npos);
}

TEST_F(QueryCommand, CountersAreThereWhenAskedFor) {
  const std::string common = "query gen:balls:2 --rays rays.npy --json ";
  EXPECT_FALSE(run(common).json().contains("counters"));
  const nlohmann::json json = run(common + "--count --structure brute_force").json();
  EXPECT_EQ(json["counters"]["primitives"], 3000 * 93);
}

TEST_F(QueryCommand, WrongRaysAndArgumentsAreRefused) {
  write_npy(folder_ / "seven.npy", npy_array(std::vector<float>(7, 1.0f), 7));
  folder_.write("text.npy", "no array at all");
  expect_error("query gen:balls:1 --rays seven.npy --json", 3, "(1, 7)");
  expect_error("query gen:balls:1 --rays text.npy --json", 3, "text.npy");
  expect_error("query gen:balls:1 --rays absent.npy --json", 3, "absent.npy");
  expect_error("query gen:balls:1 --rays rays.npy --mask rays.npy --json", 3, "(N,)");
  expect_error("query gen:balls:1 --rays rays.npy --query some --json", 2, "some");
  expect_error("query gen:balls:1 --rays rays.npy", 2, "--output");
  expect_error("query gen:balls:1 --json", 2, "--rays");
  expect_error("query gen:balls:1 --rays rays.npy -o no/folder/out.npz", 4, "no/folder");
  expect_error("query gen:balls:1 --rays rays.npy --memory 100K -o out.npz", 4, "memory limit");
}

TEST_F(QueryCommand, FailureLeavesTheOldOutputAndNothingElse) {
  folder_.write("out.npz", "old");
  const std::ptrdiff_t files = folder_.count();
  EXPECT_EQ(run("query gen:balls:2 --rays rays.npy --memory 100K -o out.npz").code, 4);
  EXPECT_EQ(folder_.read("out.npz"), "old");
  EXPECT_LE(folder_.count(), files + 2) << "besides .out and .err";
}

TEST_F(QueryCommand, InterruptEndsWith130AndLeavesNoOutput) {
  write_rays("many.npy", 2000000);
  const std::ptrdiff_t files = folder_.count();
  const std::string rays = (folder_ / "many.npy").string(), out = (folder_ / "out.npz").string();
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDERR_FILENO);
    execl(STRAHL_CLI_PATH, "strahl", "query", "gen:balls:5", "--structure", "brute_force", "--rays",
          rays.c_str(), "-o", out.c_str(), static_cast<char*>(nullptr));
    _exit(99);
  }
  // Brute force would need hours, so the signal comes while loading or tracing.
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  kill(child, SIGINT);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_EQ(folder_.count(), files);
}

}  // namespace
}  // namespace strahl::cli
