// io/bad_files_test.cpp - every malformed or nasty file has the outcome that
// tests/data/bad_expected.csv states: loads, is empty, or is an error that says where and why.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <tests/support/shared.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/io/load.h>
#include <strahl/io/text_cursor.h>

namespace strahl {
namespace {

struct Expected {
  std::string file, outcome;
  std::size_t triangles = 0;
};

bool is_supported(const std::filesystem::path& file) {
  const std::vector<std::string> known = supported_extensions();
  return std::count(known.begin(), known.end(), to_lower(file.extension().string())) > 0;
}

std::vector<Expected> expected_outcomes() {
  std::ifstream in(STRAHL_SOURCE_DIR "/tests/data/bad_expected.csv");
  std::vector<Expected> rows;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    const std::size_t a = line.find(','), b = line.find(',', a + 1);
    rows.push_back(
        {line.substr(0, a), line.substr(a + 1, b - a - 1), std::stoul(line.substr(b + 1))});
  }
  return rows;
}

// "loads", "empty" or "error"; the number of triangles if it is read.
Expected outcome_of(const std::filesystem::path& path) {
  Expected result{path.filename().string(), "error"};
  try {
    const SceneData scene = load_scene_data(path.string());
    for (const Geometry& geometry : scene.geometries) result.triangles += geometry.size();
    result.outcome = result.triangles > 0 ? "loads" : "empty";
    EXPECT_TRUE(result.triangles > 0 || !scene.warnings.empty()) << path;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input) << path;
    EXPECT_FALSE(error.which().empty()) << error.what();
    EXPECT_FALSE(error.where().empty()) << error.what();
    EXPECT_FALSE(error.reason().empty()) << error.what();
  }
  return result;
}

TEST(BadFiles, EachHasItsExpectedOutcome) {
  STRAHL_REQUIRE_SHARED("scenes/bad");
  for (const Expected& expected : expected_outcomes()) {
    const Expected got = outcome_of(test::shared_dir() / "scenes/bad" / expected.file);
    EXPECT_EQ(got.outcome, expected.outcome) << expected.file;
    EXPECT_EQ(got.triangles, expected.triangles) << expected.file;
  }
}

TEST(BadFiles, NoneIsLeftOut) {
  STRAHL_REQUIRE_SHARED("scenes/bad");
  const std::vector<Expected> rows = expected_outcomes();
  for (const auto& entry : std::filesystem::directory_iterator(test::shared_dir() / "scenes/bad")) {
    const std::string name = entry.path().filename().string();
    const bool listed = std::any_of(rows.begin(), rows.end(),
                                    [&](const Expected& row) { return row.file == name; });
    EXPECT_TRUE(listed || !is_supported(name)) << name;
  }
}

}  // namespace
}  // namespace strahl
