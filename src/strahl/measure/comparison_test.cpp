#include <algorithm>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/generators.h>
#include <strahl/measure/comparison.h>
#include <strahl/measure/statistics.h>

namespace strahl {
namespace {

std::shared_ptr<const Scene> scene_of(const char* generator) {
  return std::make_shared<const Scene>(generate_scene(generator));
}

ComparisonOptions small_options() {
  ComparisonOptions options;
  options.specs = {"bvh", "kd_tree:split=median", "brute_force"};
  options.workloads = {WorkloadKind::random, WorkloadKind::shadow, WorkloadKind::whitted};
  options.rays = 1000, options.eye_rays = 900, options.min_rays = 200, options.repeats = 3;
  return options;
}

TEST(SpreadBlocks, TakesWholeBlocksEvenlyAndNeverMoreThanThereAre) {
  EXPECT_TRUE(spread_blocks(0, 100).empty());
  EXPECT_EQ(spread_blocks(100, 100).size(), 100u);
  EXPECT_EQ(spread_blocks(100, 1000000).size(), 100u);
  EXPECT_EQ(spread_blocks(30, 1).size(), 30u);
  const auto at = spread_blocks(64000, 6400);
  ASSERT_EQ(at.size(), 6400u);
  EXPECT_TRUE(std::is_sorted(at.begin(), at.end()));
  EXPECT_EQ(std::set<std::size_t>(at.begin(), at.end()).size(), at.size());
  EXPECT_EQ(at[64], 640u);
  EXPECT_GT(at.back(), 63000u);
}

TEST(Comparison, TellsTheOverlapOnlyWhenAsked) {
  const auto scene = scene_of("balls:2");
  ComparisonOptions options = small_options();
  options.workloads = {WorkloadKind::random};
  EXPECT_FALSE(compare_structures(scene, *scene->data().view, options).rows[0].overlap);
  options.with_overlap = true;
  const SceneComparison c = compare_structures(scene, *scene->data().view, options);
  EXPECT_EQ(c.rows[0].overlap, build(scene, "bvh")->end_point_overlap({}));
  EXPECT_FALSE(c.rows[1].overlap);
}

TEST(Comparison, MeasuresEveryStructureOnEveryWorkload) {
  const auto scene = scene_of("balls:2");
  const ComparisonOptions options = small_options();
  const SceneComparison c = compare_structures(scene, *scene->data().view, options);
  ASSERT_EQ(c.rows.size(), 3u);
  ASSERT_EQ(c.workloads.size(), 3u);
  EXPECT_EQ(c.rows[1].spec, "kd_tree:split=median");
  EXPECT_EQ(c.workloads[0].closest_rays, 1000u);
  EXPECT_GT(c.workloads[2].any_rays, c.workloads[2].any_hits);
  EXPECT_EQ(c.workloads[0].eye_rays, 0u);  // lines
  EXPECT_EQ(c.workloads[2].eye_rays, 900u);
  EXPECT_EQ(c.workloads[2].eye_hits, 900u);  // the ground is everywhere
  EXPECT_LT(c.workloads[2].eye_hits, c.workloads[2].closest_hits);
  for (const ComparisonRow& row : c.rows) {
    EXPECT_EQ(row.build.references > 0 || row.spec == "brute_force", true);
    ASSERT_EQ(row.cells.size(), 3u);
    ASSERT_EQ(row.build_seconds.size(), 3u);  // built anew for each repeat
    EXPECT_EQ(row.build.seconds, median(row.build_seconds));
    for (std::size_t w = 0; w < 3; ++w) {
      const ComparisonCell& cell = row.cells[w];
      EXPECT_EQ(cell.workload, options.workloads[w]);
      EXPECT_EQ(cell.seconds.size(), 3u);
      EXPECT_GE(cell.rays, 200u);
      EXPECT_GT(cell.counters.primitives, 0u);
    }
  }
  // All rays test all primitives by brute force.
  const ComparisonCell& brute = c.rows[2].cells[0];
  EXPECT_EQ(brute.counters.primitives, brute.rays * scene->size());
}

TEST(Comparison, ASlowStructureIsAskedFewerRays) {
  const auto scene = scene_of("balls:3");
  ComparisonOptions options = small_options();
  options.specs = {"bvh", "brute_force"}, options.workloads = {WorkloadKind::random};
  options.rays = 20000, options.min_rays = 640, options.seconds_per_cell = 0.005;
  const SceneComparison c = compare_structures(scene, *scene->data().view, options);
  EXPECT_EQ(c.rows[1].cells[0].rays, 640u);
  EXPECT_GT(c.rows[0].cells[0].rays, 640u);
}

TEST(Comparison, DrawsTheWorkOfEveryStructureFromTheView) {
  const auto scene = scene_of("balls:2");
  ComparisonOptions options = small_options();
  options.workloads = {WorkloadKind::random}, options.map_width = 8, options.map_height = 6;
  const SceneComparison c = compare_structures(scene, *scene->data().view, options);
  for (const ComparisonRow& row : c.rows) {
    ASSERT_EQ(row.maps.steps.size(), 48u);
    ASSERT_EQ(row.maps.tests.size(), 48u);
  }
  EXPECT_EQ(c.rows[2].maps.tests, std::vector<float>(48, static_cast<float>(scene->size())));
  EXPECT_NE(c.rows[0].maps.tests, c.rows[1].maps.tests);
}

TEST(Comparison, CanBeCancelledAndRefusesNothingToCompare) {
  const auto scene = scene_of("tetra:3");
  ComparisonOptions options = small_options();
  BuildContext context;
  context.progress = [](double, std::string_view stage) { return stage.rfind("timing", 0) != 0; };
  try {
    compare_structures(scene, *scene->data().view, options, context);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
  options.specs.clear();
  EXPECT_THROW(compare_structures(scene, *scene->data().view, options), Error);
}

}  // namespace
}  // namespace strahl
