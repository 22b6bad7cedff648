// Every structure against brute force on the shared scene files: the same bits for every query.
//
// STRAHL_CONFORMANCE=full takes all files and, where they are not huge, every option value alone;
// without it just the defaults on small files. Rays are fewer in larger scenes, as brute force
// answers them.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <tests/conformance/oracle.h>
#include <tests/conformance/variants.h>
#include <tests/support/shared.h>

#include <gtest/gtest.h>

#include <strahl/io/load.h>

namespace strahl::test {
namespace {

constexpr std::uint64_t kSeed = 44;
const std::uintmax_t kSmallFile = is_smoke_run() ? 32 * 1024 : 256 * 1024;
constexpr std::uint32_t kHuge = 200'000;
constexpr double kTestsPerQuery = 2e7;

bool is_scene_file(const std::filesystem::directory_entry& entry) {
  const std::string extension = entry.path().extension().string();
  return entry.is_regular_file() && extension != ".md" && extension != ".mtl" &&
         extension != ".txt";
}

std::vector<std::string> scene_files(std::uintmax_t most_bytes) {
  std::vector<std::string> names;
  if (!std::filesystem::exists(shared_dir() / "scenes")) return names;
  for (const auto& entry : std::filesystem::directory_iterator(shared_dir() / "scenes"))
    if (is_scene_file(entry) && entry.file_size() <= most_bytes)
      names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::size_t ray_count(const Scene& scene) {
  const double affordable = kTestsPerQuery / std::max(scene.size(), 1u);
  return static_cast<std::size_t>(std::clamp(affordable, 40.0, is_full_run() ? 400.0 : 100.0));
}

std::vector<std::string> specs_for(const StructureEntry& entry, const Scene& scene) {
  if (is_full_run() && scene.size() <= kHuge) return one_at_a_time(entry);
  return {entry.name};
}

class RealScene : public testing::TestWithParam<std::string> {};

TEST_P(RealScene, EveryStructureAnswersLikeBruteForce) {
  const auto scene = std::make_shared<const Scene>(
      load_scene_data((shared_dir() / "scenes" / GetParam()).string()));
  const Expected expected = expected_answers(scene, ray_count(*scene), kSeed);
  for (const StructureEntry& entry : all_structures())
    for (const std::string& spec : specs_for(entry, *scene))
      ASSERT_EQ(first_difference(scene, spec, expected), "") << spec;
}

std::string identifier(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RealScene);
INSTANTIATE_TEST_SUITE_P(SharedFiles, RealScene,
                         testing::ValuesIn(scene_files(is_full_run() ? UINTMAX_MAX : kSmallFile)),
                         identifier);

TEST(RealScenes, AreAllThere) {
  STRAHL_REQUIRE_SHARED("scenes");
  EXPECT_EQ(scene_files(UINTMAX_MAX).size(), 44u);
}

}  // namespace
}  // namespace strahl::test
