// io/bad_files_test.cpp - every malformed or nasty file has the outcome that
// tests/data/bad_expected.csv states: loads, is empty, or is an error that says where and why.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <tests/support/shared.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/io/off.h>
#include <strahl/io/ply.h>
#include <strahl/io/stl.h>
#include <strahl/io/text_cursor.h>

namespace strahl {
namespace {

using Reader = SceneData (*)(const FileBytes&);

struct Expected {
  std::string file, outcome;
  std::size_t triangles = 0;
};

const std::map<std::string, Reader>& readers() {
  static const std::map<std::string, Reader> table{
      {".off", read_off}, {".ply", read_ply}, {".stl", read_stl}};
  return table;
}

Reader reader_of(const std::filesystem::path& file) {
  const auto entry = readers().find(to_lower(file.extension().string()));
  return entry == readers().end() ? nullptr : entry->second;
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
    const SceneData scene = reader_of(path)(map_file(path));
    for (const Geometry& geometry : scene.geometries) result.triangles += geometry.size();
    result.outcome = result.triangles > 0 ? "loads" : "empty";
    EXPECT_TRUE(result.triangles > 0 || !scene.warnings.empty()) << path;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input) << path;
    EXPECT_EQ(error.which(), path.string());
    EXPECT_FALSE(error.where().empty()) << error.what();
    EXPECT_FALSE(error.reason().empty()) << error.what();
  }
  return result;
}

TEST(BadFiles, EachHasItsExpectedOutcome) {
  STRAHL_REQUIRE_SHARED("scenes/bad");
  for (const Expected& expected : expected_outcomes()) {
    if (!reader_of(expected.file)) continue;
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
    EXPECT_TRUE(listed || !reader_of(name)) << name;
  }
}

}  // namespace
}  // namespace strahl
