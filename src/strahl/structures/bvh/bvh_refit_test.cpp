// Hierarchies that follow their things: what stays, when they are built anew, what failures leave.
#include <cmath>
#include <string>
#include <tests/support/box_source.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/base/rng.h>
#include <strahl/bounds/all_volumes.h>
#include <strahl/structures/bvh/bvh.h>
#include <strahl/structures/bvh/bvh_refit.h>

namespace strahl {
namespace {

using test::Boxes;

Boxes random_boxes(std::size_t count) {
  Rng rng(1);
  Boxes source;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d lo{rng.uniform(), rng.uniform(), rng.uniform()};
    source.boxes.push_back(
        {lo, lo + Vec3d{rng.uniform(0, 0.1), rng.uniform(0, 0.1), rng.uniform(0, 0.1)}});
  }
  return source;
}

/// Each box moved by up to `reach`.
Boxes shaken(Boxes source, double reach) {
  Rng rng(2);
  for (Aabb& box : source.boxes) {
    const Vec3d by{rng.uniform(-reach, reach), rng.uniform(-reach, reach),
                   rng.uniform(-reach, reach)};
    box = {box.lo + by, box.hi + by};
  }
  return source;
}

std::uint64_t hash_of(const Bvh& bvh) {
  Hash64 hash;
  bvh.hash_into(hash);
  return hash.digest();
}

BvhOptions lasting() {
  BvhOptions options;
  options.rebuild_factor = 1000.0;
  return options;
}

TEST(BvhRefit, WrapsEveryKindOfVolumeAnew) {
  const Boxes before = random_boxes(150), after = shaken(before, 0.2);
  for (int kind = 0; kind <= static_cast<int>(BvhVolume::automatic); ++kind) {
    SCOPED_TRACE(kind);
    BvhOptions options = lasting();
    options.bv = static_cast<BvhVolume>(kind);
    Bvh bvh(before, options, {});
    const std::uint64_t fresh = hash_of(bvh);
    bvh.refit(after, {});
    EXPECT_EQ(bvh.refits(), 1u);
    EXPECT_NO_THROW(bvh.validate(after));
    EXPECT_THROW(bvh.validate(before), std::logic_error);
    bvh.refit(before, {});
    EXPECT_EQ(bvh.refits(), 2u);
    EXPECT_EQ(hash_of(bvh), fresh) << "back where things were";
  }
}

TEST(BvhRefit, MakesTheTightestBoxesThatTheTreeAllows) {
  const Boxes before = random_boxes(500), after = shaken(before, 0.3);
  Bvh bvh(before, lasting(), {});
  bvh.refit(after, {});
  const Hierarchy fitted = *fit_hierarchy(bvh.tree()->hierarchy(), after, lasting(), {});
  for (std::size_t i = 0; i < fitted.nodes.size(); ++i) {
    Aabb expected;
    std::vector<std::size_t> waiting{i};
    while (!waiting.empty()) {
      const HierarchyNode& at = fitted.nodes[waiting.back()];
      waiting.pop_back();
      for (std::uint32_t k = 0; k < at.children; ++k) waiting.push_back(at.first + k);
      for (std::uint32_t k = 0; k < at.count; ++k)
        expected.extend(after.boxes[fitted.references[at.first + k]]);
    }
    ASSERT_EQ(fitted.nodes[i].box, expected) << i;
  }
  EXPECT_NEAR(bvh.report().sah_cost, fitted.sah_cost({1.0, 1.0}), 1e-6 * bvh.report().sah_cost);
}

TEST(BvhRefit, BuildsAnewWhereTheCostHasGrownByTheFactor) {
  const Boxes before = random_boxes(500), after = shaken(before, 0.1);
  Bvh lasting_bvh(before, lasting(), {});
  const double built = lasting_bvh.report().sah_cost;
  lasting_bvh.refit(after, {});
  const double growth = lasting_bvh.report().sah_cost / built;
  ASSERT_GT(growth, 1.2);
  for (const double factor : {0.99 * growth, 1.01 * growth}) {
    BvhOptions options;
    options.rebuild_factor = factor;
    Bvh bvh(before, options, {});
    bvh.refit(after, {});
    const bool is_new = factor < growth;
    EXPECT_EQ(bvh.refits(), is_new ? 0u : 1u);
    EXPECT_EQ(hash_of(bvh) == hash_of(Bvh(after, options, {})), is_new);
    EXPECT_NO_THROW(bvh.validate(after));
  }
}

TEST(BvhRefit, ComparesWithTheCostWhenItWasBuiltNotWithTheLastOne) {
  const Boxes start = random_boxes(500);
  BvhOptions options;
  options.rebuild_factor = 1.3;
  Bvh bvh(start, options, {});
  int rebuilt_after = 0;
  for (int step = 1; rebuilt_after == 0 && step <= 50; ++step) {
    bvh.refit(shaken(start, 0.004 * step), {});  // each a little more than the one before
    if (bvh.refits() == 0) rebuilt_after = step;
  }
  EXPECT_GT(rebuilt_after, 3);
  EXPECT_LT(rebuilt_after, 50);
}

TEST(BvhRefit, HoldsWholeWhatTheBuilderHasCut) {
  Boxes before = random_boxes(200);
  for (std::size_t i = 0; i < 100; ++i) before.boxes[i].hi[static_cast<int>(i % 3)] += 0.5;
  BvhOptions options = lasting();
  options.builder = BvhBuilder::spatial;
  Bvh bvh(before, options, {});
  ASSERT_FALSE(bvh.refers_once());
  const std::uint64_t references = bvh.report().references;
  const Boxes after = shaken(before, 0.1);
  bvh.refit(after, {});
  EXPECT_EQ(bvh.refits(), 1u);
  EXPECT_EQ(bvh.report().references, references);
  EXPECT_FALSE(bvh.refers_once());
  EXPECT_NO_THROW(bvh.validate(after));
}

TEST(BvhRefit, LeavesEverythingWhereItFails) {
  const Boxes before = random_boxes(1000), after = shaken(before, 0.2);
  Bvh bvh(before, lasting(), {});
  const std::uint64_t fresh = hash_of(bvh);
  BuildContext cancelled, small;
  cancelled.progress = [](double, std::string_view) { return false; };
  small.memory_limit = 10'000;
  for (const BuildContext* context : {&cancelled, &small}) {
    EXPECT_THROW(bvh.refit(after, *context), Error);
    EXPECT_EQ(hash_of(bvh), fresh);
    EXPECT_EQ(bvh.refits(), 0u);
    EXPECT_NO_THROW(bvh.validate(before));
  }
}

TEST(BvhRefit, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const Boxes before = random_boxes(20000), after = shaken(before, 0.2);
  BuildContext two;
  two.executor = Executor::with_threads(2);
  Bvh a(before, lasting(), {}), b(before, lasting(), {});
  a.refit(after, {}), b.refit(after, two);
  EXPECT_EQ(hash_of(a), hash_of(b));
}

}  // namespace
}  // namespace strahl
