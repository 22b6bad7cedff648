// tests/regression/bvh_builders_test.cpp - optimisers on real parts: a median-cut tree comes within
// a tenth of the cost of the exact SAH sweep.
#include <algorithm>
#include <string>
#include <tests/support/parts.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/catalog/catalog.h>

namespace strahl::test {
namespace {

double cost_of(const std::shared_ptr<const Scene>& scene, const std::string& options) {
  const auto bvh = build(scene, "bvh:" + options);
  bvh->validate();
  return bvh->report().sah_cost;
}

TEST(BvhBuilders, ReinsertionBringsMedianCutNearTheSweepOnRealParts) {
  STRAHL_REQUIRE_SHARED("scenes/spot.obj");
  for (const std::string name : {"spot.obj", "suzanne.obj", "teapot.obj", "cycloidal.ply"}) {
    const auto scene = std::make_shared<const Scene>(part(name));
    const double sweep = cost_of(scene, "builder=sah_sweep");
    for (const std::string builder : {"median_cyclic", "median_longest"}) {
      const double median = cost_of(scene, "builder=" + builder);
      EXPECT_GT(median, sweep) << name;
      EXPECT_LT(cost_of(scene, "builder=" + builder + ",optimise=reinsertion"), 1.1 * sweep)
          << name;
      EXPECT_LT(cost_of(scene, "builder=" + builder + ",optimise=rotations"), median) << name;
    }
  }
}

}  // namespace
}  // namespace strahl::test
