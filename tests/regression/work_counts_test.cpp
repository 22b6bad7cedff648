// tests/regression/work_counts_test.cpp - primitive tests and cells entered per ray of uniform
// grids and octrees, over the ray trees of the standard scenes, as published [Havran1999].
//
// They agree within 10 %, with 65 x 65 of the 513 x 513 primary rays. N_IT of octrees was evidently
// published per ray that hits something: so it agrees on every scene and at every depth, per ray on
// none. Without `gears`, whose published counts were of polygons of 144 corners, here of the
// triangles of such, and whose rays entered more cells than a box as high as its grid holds.
#include <string>
#include <tests/support/published.h>

#include <gtest/gtest.h>

#include <strahl/catalog/catalog.h>
#include <strahl/io/generators.h>
#include <strahl/measure/workloads.h>

namespace strahl {
namespace {

constexpr double kTolerance = 0.1;
constexpr std::size_t kPrimaryRays = 65 * 65;

struct Case {
  const char* name;
  const char* generator;
  const char* cells;  ///< of the grid with ten cells per object, as published
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

struct Work {
  double tests, cells;        ///< per ray
  double hits_per_ray = 0.0;  ///< share of rays that hit
};

Work trace(const std::shared_ptr<const Scene>& scene, const std::string& spec) {
  const auto accelerator = build(scene, spec);
  WorkloadOptions options;
  options.view = scene->data().view.value();
  options.rays = kPrimaryRays;
  const Workload rays = make_workload(WorkloadKind::whitted, *accelerator, options);
  std::vector<Hit> hits(rays.closest.size());
  std::vector<std::uint8_t> any(rays.any.size());
  const BatchContext counting{{}, true};
  Counters sum = accelerator->closest_hit(make_batch(rays.closest), hits, counting).counters;
  sum += accelerator->any_hit(make_batch(rays.any), any, counting).counters;
  double found = 0.0;
  for (const Hit& hit : hits) found += hit.is_hit() ? 1.0 : 0.0;
  for (const std::uint8_t hit : any) found += hit;
  const auto count = static_cast<double>(rays.size());
  return {double(sum.primitives) / count, double(sum.leaves) / count, found / count};
}

void expect_near(double got, const std::string& key) {
  const double expected = test::published().at(key);
  EXPECT_NEAR(got, expected, kTolerance * expected) << key;
}

class WorkCounts : public testing::TestWithParam<Case> {};

TEST_P(WorkCounts, OfAGridAreThePublishedOnes) {
  STRAHL_REQUIRE_SHARED("reference/havran_1999.csv");
  const auto scene = std::make_shared<const Scene>(generate_scene(GetParam().generator));
  const Work work =
      trace(scene, std::string("grid:resolution=fixed,exact=off,mailbox=off,") + GetParam().cells);
  const std::string key = std::string("UG,woo_D10,") + GetParam().name;
  expect_near(work.tests, key + ",N_IT");
  expect_near(work.cells, key + ",N_ETS");
}

TEST_P(WorkCounts, OfAnOctreeAreThePublishedOnes) {
  STRAHL_REQUIRE_SHARED("reference/havran_1999.csv");
  const auto scene = std::make_shared<const Scene>(generate_scene(GetParam().generator));
  const Work work =
      trace(scene, "octree:split=middle,exact=off,max_prims=1,max_growth=1000000,max_depth=6");
  const std::string key = std::string("Octree84-C,d6,") + GetParam().name;
  expect_near(work.tests / work.hits_per_ray, key + ",N_IT");
  expect_near(work.cells, key + ",N_ETS");
}

INSTANTIATE_TEST_SUITE_P(StandardScenes, WorkCounts,
                         testing::Values(Case{"balls", "balls:4", "nx=103,ny=103,nz=7"},
                                         Case{"lattice", "lattice:12", "nx=44,ny=44,nz=44"},
                                         Case{"mount", "mount:6", "nx=44,ny=44,nz=42"},
                                         Case{"rings", "rings:7", "nx=44,ny=43,nz=44"},
                                         Case{"teapot", "teapot:12", "nx=61,ny=61,nz=25"},
                                         Case{"tetra", "tetra:6", "nx=35,ny=35,nz=35"},
                                         Case{"tree", "tree:11", "nx=117,ny=118,nz=5"}),
                         [](const auto& i) { return std::string(i.param.name); });

}  // namespace
}  // namespace strahl
