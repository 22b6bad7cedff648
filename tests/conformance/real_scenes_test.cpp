// Every structure against brute force on the shared scene files: the same bits for every query.
//
// STRAHL_CONFORMANCE=full takes all files, on each the defaults of every structure and, alone,
// every option value on small files, every eighth and every 64th on larger ones, at most one beyond
// a million primitives: each value meets all small files, other files meet different ones. It
// prints what it did. Without it, just the defaults on small files. Brute force answers the rays of
// a file once; in larger scenes they are fewer, as it tests every primitive.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <tests/conformance/oracle.h>
#include <tests/conformance/variants.h>
#include <tests/support/shared.h>

#include <gtest/gtest.h>

#include <strahl/base/timer.h>
#include <strahl/io/load.h>

namespace strahl::test {
namespace {

constexpr std::uint64_t kSeed = 44;
const std::uintmax_t kSmallFile = is_smoke_run() ? 32 * 1024 : 256 * 1024;
constexpr double kTestsPerQuery = 2e7;

/// One option value in `stride` is tried on scenes of up to so many primitives.
struct Share {
  std::uint32_t most_primitives;
  std::size_t stride;
};
constexpr Share kShares[] = {{3'000, 1}, {30'000, 8}, {1'000'000, 64}, {UINT32_MAX, 1000}};

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

/// Place of the file among all.
std::size_t number_of(const std::string& file) {
  const std::vector<std::string> files = scene_files(UINTMAX_MAX);
  return static_cast<std::size_t>(std::ranges::find(files, file) - files.begin());
}

std::size_t ray_count(const Scene& scene) {
  const double affordable = kTestsPerQuery / std::max(scene.size(), 1u);
  return static_cast<std::size_t>(std::clamp(affordable, 40.0, is_full_run() ? 400.0 : 100.0));
}

/// Its time is quadratic: minutes for scenes that others divide in a second.
bool is_affordable(const std::string& spec, const Scene& scene) {
  return scene.size() <= kShares[0].most_primitives || spec.find("sah_naive") == std::string::npos;
}

std::size_t stride_of(const Scene& scene) {
  return std::ranges::find_if(kShares,
                              [&](const Share& s) { return scene.size() <= s.most_primitives; })
      ->stride;
}

/// Every option value alone, of all structures.
std::vector<std::string> single_values() {
  std::vector<std::string> specs;
  for (const StructureEntry& entry : all_structures()) {
    std::vector<std::string> own = one_at_a_time(entry);
    own.erase(own.begin());
    for (std::string& spec : outer_values(entry))
      if (std::ranges::find(own, spec) == own.end()) own.push_back(std::move(spec));
    specs.insert(specs.end(), own.begin(), own.end());
  }
  return specs;
}

/// @param file number of the file, which decides what values it takes
std::vector<std::string> specs_for(const Scene& scene, std::size_t file) {
  std::vector<std::string> specs;
  for (const StructureEntry& entry : all_structures())
    if (entry.name != std::string("brute_force")) specs.emplace_back(entry.name);  // the oracle
  if (!is_full_run()) return specs;
  const std::vector<std::string> alone = single_values();
  const std::size_t stride = stride_of(scene);
  for (std::size_t i = file % stride; i < alone.size(); i += stride)
    if (is_affordable(alone[i], scene)) specs.push_back(alone[i]);
  return specs;
}

/// What a full run has done; said as it goes on, for it takes long.
class Progress {
 public:
  void add(const std::string& spec, double seconds) {
    ++specs_, total_ += seconds;
    if (seconds > slowest_) slowest_ = seconds, slowest_spec_ = spec;
  }
  void print(const std::string& file, const Scene& scene, const Expected& expected) const {
    if (!is_full_run()) return;
    std::printf("%s: %u primitives, %zu rays, %zu SPECs, %.1f s, longest %.1f s: %s\n",
                file.c_str(), scene.size(), expected.set.rays.size(), specs_, total_, slowest_,
                slowest_spec_.c_str());
    std::fflush(stdout);
  }

 private:
  std::size_t specs_ = 0;
  double total_ = 0.0, slowest_ = 0.0;
  std::string slowest_spec_;
};

class RealScene : public testing::TestWithParam<std::string> {};

TEST_P(RealScene, EveryStructureAnswersLikeBruteForce) {
  const auto scene = std::make_shared<const Scene>(
      load_scene_data((shared_dir() / "scenes" / GetParam()).string()));
  const Expected expected = expected_answers(scene, ray_count(*scene), kSeed);
  Progress progress;
  for (const std::string& spec : specs_for(*scene, number_of(GetParam()))) {
    const Timer timer;
    ASSERT_EQ(first_difference(scene, spec, expected), "") << spec;
    progress.add(spec, timer.seconds());
  }
  progress.print(GetParam(), *scene, expected);
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
