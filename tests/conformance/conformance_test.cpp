// Every structure of the catalogue against brute force: the same bits for every query.
//
// STRAHL_CONFORMANCE=full asks all rays of every SPEC on every scene, tries single options, too,
// and takes the full product of options on the tiny scenes. Without it, SPECs with options get
// fewer rays and each a quarter of the scenes, so that each scene still meets a quarter of the
// SPECs. STRAHL_CONFORMANCE=smoke asks few rays of one SPEC in sixteen.
#include <algorithm>
#include <map>
#include <tests/conformance/oracle.h>
#include <tests/conformance/scenes.h>
#include <tests/conformance/variants.h>
#include <utility>

#include <gtest/gtest.h>

namespace strahl::test {
namespace {

std::size_t by_thoroughness(std::size_t smoke, std::size_t usual, std::size_t full) {
  return is_full_run() ? full : is_smoke_run() ? smoke : usual;
}

const std::size_t kRays = by_thoroughness(80, 400, 1600);
const std::size_t kFewRays = by_thoroughness(40, 100, 1600);
const std::size_t kWalkedRays = by_thoroughness(10, 60, 200);
constexpr std::uint64_t kSeed = 2026;

/// Rays of a scene and what brute force says; made once per process.
const Expected& expected_of(const NamedScene& named, std::size_t rays = kRays) {
  static std::map<std::pair<std::string, std::size_t>, Expected> cache;
  const auto found = cache.find({named.name, rays});
  if (found != cache.end()) return found->second;
  return cache.emplace(std::pair(named.name, rays), expected_answers(scene_of(named), rays, kSeed))
      .first->second;
}

void expect_conforms(const NamedScene& named, const std::string& spec) {
  SCOPED_TRACE(spec + " on " + named.name + ", seed " + std::to_string(kSeed));
  const bool has_options = spec.find(':') != std::string::npos;
  const Expected& e = expected_of(named, has_options ? kFewRays : kRays);
  ASSERT_EQ(first_difference(scene_of(named), spec, e), "");
}

struct Param {
  const StructureEntry* entry;
  const NamedScene* scene;

  /// Whether SPEC number i of the structure is tried on this scene.
  bool takes(std::size_t i) const {
    const auto number = static_cast<std::size_t>(scene - adversarial_scenes().data());
    if (is_smoke_run()) return (i + number) % 16 == 0;
    return is_full_run() || scene->is_tiny || (i + number) % 4 == 0;
  }
};

void PrintTo(const Param& p, std::ostream* out) {
  *out << p.entry->name << " on " << p.scene->name;
}

std::vector<Param> all_params() {
  std::vector<Param> params;
  for (const StructureEntry& entry : all_structures())
    for (const NamedScene& scene : adversarial_scenes()) params.push_back({&entry, &scene});
  return params;
}

class Conformance : public testing::TestWithParam<Param> {};

TEST_P(Conformance, EveryPairOfOptionValuesAnswersLikeBruteForce) {
  const std::vector<std::string> specs = covering(*GetParam().entry, 2);
  for (std::size_t i = 0; i < specs.size(); ++i)
    if (GetParam().takes(i)) expect_conforms(*GetParam().scene, specs[i]);
}

TEST_P(Conformance, DefaultsAndSingleOptionsAnswerLikeBruteForce) {
  const StructureEntry& entry = *GetParam().entry;
  if (entry.name == std::string("brute_force")) return;  // it is the oracle
  for (const std::string& spec :
       is_full_run() ? one_at_a_time(entry) : std::vector{std::string(entry.name)})
    expect_conforms(*GetParam().scene, spec);
}

TEST_P(Conformance, OuterValuesOfNumbersAnswerLikeBruteForce) {
  const std::vector<std::string> specs = outer_values(*GetParam().entry);
  for (std::size_t i = 0; i < specs.size(); ++i)
    if (GetParam().takes(i)) expect_conforms(*GetParam().scene, specs[i]);
}

/// All combinations on tiny scenes; of structures with too many, every combination of three values.
TEST_P(Conformance, OptionsTogetherAnswerLikeBruteForce) {
  if (!GetParam().scene->is_tiny) return;
  std::vector<std::string> specs = full_product(*GetParam().entry, is_full_run() ? 20000 : 400);
  if (specs.empty()) specs = covering(*GetParam().entry, is_smoke_run() ? 2 : 3);
  for (std::size_t i = 0; i < specs.size(); ++i)
    if (!is_smoke_run() || GetParam().takes(i)) expect_conforms(*GetParam().scene, specs[i]);
}

TEST_P(Conformance, ThreadsAndBatchSizesDoNotChangeBits) {
  const NamedScene& named = *GetParam().scene;
  const Expected& e = expected_of(named);
  const auto serial = build(scene_of(named), GetParam().entry->name);
  BuildContext two;
  two.executor = Executor::with_threads(2);
  const auto parallel = build(scene_of(named), GetParam().entry->name, two);
  EXPECT_EQ(serial->tree_hash(), parallel->tree_hash());
  EXPECT_EQ(first_difference(ask(*parallel, e.set, two), e.answers), "");
  const Expected& few = expected_of(named, kFewRays);
  EXPECT_EQ(first_difference(ask(*serial, few.set, {}, 7), few.answers), "");
}

TEST_P(Conformance, CountingWorkDoesNotChangeBits) {
  const NamedScene& named = *GetParam().scene;
  const Expected& e = expected_of(named);
  const auto accelerator = build(scene_of(named), GetParam().entry->name);
  BatchContext counted;
  counted.count_work = true;
  std::vector<Hit> hits(e.set.rays.size());
  const BatchReport report = accelerator->closest_hit(e.set.batch(false), hits, counted);
  for (std::size_t i = 0; i < hits.size(); ++i)
    ASSERT_TRUE(have_same_bits(hits[i], e.answers.closest[0][i])) << i;
  EXPECT_EQ(report.counters.primitives > 0, scene_of(named)->size() > 0);
}

TEST_P(Conformance, AWalkByCursorsListsExactlyAllHits) {
  const NamedScene& named = *GetParam().scene;
  const Expected& e = expected_of(named);
  const auto accelerator = build(scene_of(named), GetParam().entry->name);
  RaySet set = e.set;
  const AllHits& all = e.answers.all[0];
  std::size_t left = std::min(set.rays.size(), kWalkedRays);
  set.rays.resize(left), set.after.resize(left);
  std::vector<std::int64_t> at(all.splits.begin(), all.splits.end() - 1);
  for (int step = 0; left > 0 && step < 5000; ++step) {
    RayBatch batch = set.batch(false);
    batch.after = set.after;
    if (step == 0) batch.after = {};
    std::vector<Hit> hits(set.rays.size());
    accelerator->closest_hit(batch, hits);
    left = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const bool more = at[i] < all.splits[i + 1];
      ASSERT_EQ(hits[i].is_hit(), more) << "ray " << i << " step " << step;
      if (!more) continue;
      ASSERT_TRUE(have_same_bits(hits[i], all.hits[static_cast<std::size_t>(at[i])])) << i;
      set.after[i] = {hits[i].t, hits[i].id};
      ++at[i], ++left;
    }
    if (named.name == "identical" && step > 20) break;  // more equal steps say no more
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Conformance, testing::ValuesIn(all_params()),
                         [](const testing::TestParamInfo<Param>& i) {
                           return std::string(i.param.entry->name) + "_" + i.param.scene->name;
                         });

}  // namespace
}  // namespace strahl::test
