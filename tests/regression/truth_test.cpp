// Real scenes against expected answers made outside of this project: for every binary PLY of the
// shared scenes, 300 rays whose nearest hits were found in 80-bit arithmetic over all primitives.
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <tests/support/queries.h>
#include <tests/support/shared.h>

#include <gtest/gtest.h>

#include <strahl/io/load.h>

namespace strahl::test {
namespace {

constexpr const char* kTable = "reference/truth_public.csv";
constexpr double kRelative = 1e-9;
constexpr std::uint32_t kQuickPrimitives = 40'000;

struct Row {
  Ray ray;
  bool is_hit = false, is_ambiguous = false;
  double t = 0.0;
  std::uint32_t primitive = 0, crossings = 0;
};

/// scene,ray,ox,oy,oz,dx,dy,dz,hit,t,primitive,n_crossings,ambiguous; nine digits restore the
/// float32 of an origin or direction.
Row parse_row(const std::vector<std::string>& cells) {
  const auto number = [&](std::size_t i) { return std::strtod(cells[i].c_str(), nullptr); };
  const auto single = [&](std::size_t i) {
    return static_cast<double>(std::strtof(cells[i].c_str(), nullptr));
  };
  Row row;
  row.ray = {{single(2), single(3), single(4)}, {single(5), single(6), single(7)}};
  row.is_hit = cells[8] == "1", row.is_ambiguous = cells[12] == "1";
  row.t = number(9);
  row.primitive = static_cast<std::uint32_t>(number(10));
  row.crossings = static_cast<std::uint32_t>(number(11));
  return row;
}

std::map<std::string, std::vector<Row>> read_table() {
  std::map<std::string, std::vector<Row>> rows;
  std::ifstream file(shared_dir() / kTable);
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    if (cells.size() == 13) rows[cells[0]].push_back(parse_row(cells));
  }
  return rows;
}

const std::map<std::string, std::vector<Row>>& table() {
  static const auto rows = read_table();
  return rows;
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& [name, rows] : table()) names.push_back(name);
  return names;
}

/// Crossed primitives; a sphere whose two roots are hit counts once.
std::size_t crossed_primitives(std::span<const Hit> hits) {
  std::set<PrimitiveId> ids;
  for (const Hit& hit : hits) ids.insert(hit.id);
  return ids.size();
}

/// Large scenes are asked of these only, unless all is asked for.
bool is_spine(std::string_view name) {
  return name == "brute_force" || name == "bvh" || name == "kd_tree" || name == "grid";
}

class Truth : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    rows_ = table().at(GetParam());
    for (const Row& row : rows_) rays_.push_back(row.ray);
    scene_ = std::make_shared<const Scene>(
        load_scene_data((shared_dir() / "scenes" / GetParam()).string()));
    for (const StructureEntry& entry : all_structures())
      if (is_full_run() || scene_->size() <= kQuickPrimitives || is_spine(entry.name))
        structures_.push_back(build(scene_, entry.name));
    for (const auto& s : structures_) closest_.push_back(closest_hits(*s, make_batch(rays_)));
  }

  std::vector<Row> rows_;
  std::vector<Ray> rays_;
  std::shared_ptr<const Scene> scene_;
  std::vector<std::unique_ptr<Accelerator>> structures_;
  std::vector<std::vector<Hit>> closest_;  ///< per structure
};

void expect_hit(const Hit& hit, const Row& row) {
  ASSERT_EQ(hit.is_hit(), row.is_hit);
  if (!row.is_hit) return;
  EXPECT_EQ(hit.id.prim, row.primitive);
  EXPECT_NEAR(hit.t, row.t, kRelative * std::abs(row.t));
}

TEST_P(Truth, EveryStructureAgreesOnRowsThatAreNotAmbiguousAndWithTheOthersOnAll) {
  for (std::size_t s = 0; s < structures_.size(); ++s) {
    SCOPED_TRACE(structures_[s]->spec());
    ASSERT_NO_THROW(structures_[s]->validate());
    const AllHits all = all_hits(*structures_[s], make_batch(rays_));
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      SCOPED_TRACE("row " + std::to_string(i));
      const Hit &hit = closest_[s][i], &first = closest_[0][i];
      ASSERT_TRUE(same_bits(hit, first));
      ASSERT_TRUE(
          same_bits(surface_at(*scene_, rays_[i], hit), surface_at(*scene_, rays_[i], first)));
      if (rows_[i].is_ambiguous) continue;
      expect_hit(hit, rows_[i]);
      EXPECT_EQ(crossed_primitives(hits_of(all, i)), rows_[i].crossings);
    }
  }
}

std::string identifier(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Truth);
INSTANTIATE_TEST_SUITE_P(PublicScenes, Truth, testing::ValuesIn(scene_names()), identifier);

TEST(TruthTable, HoldsThreeHundredRaysOfEveryScene) {
  STRAHL_REQUIRE_SHARED(kTable);
  EXPECT_EQ(table().size(), 18u);
  for (const auto& [name, rows] : table()) EXPECT_EQ(rows.size(), 300u) << name;
}

}  // namespace
}  // namespace strahl::test
