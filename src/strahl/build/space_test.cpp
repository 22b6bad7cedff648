#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/build/memory_meter.h>
#include <strahl/build/space_bins.h>
#include <strahl/build/space_median.h>
#include <strahl/build/space_naive.h>
#include <strahl/build/space_sweep.h>

namespace strahl {
namespace {

constexpr SahCost kUnitCost{1.0, 1.0};

PrimRef ref_of(const Vec3d& lo, const Vec3d& hi, std::uint32_t reference = 0) {
  return {{lo, hi}, reference};
}

/// Boxes whose ends lie on a coarse lattice, so that many coincide and many are planar.
std::vector<Fragment> lattice_fragments(Rng& rng, std::size_t count) {
  std::vector<PrimRef> refs;
  for (std::size_t i = 0; i < count; ++i) {
    Vec3d lo, hi;
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = static_cast<double>(rng.below(8));
      hi[axis] = std::min(8.0, lo[axis] + static_cast<double>(rng.below(4)));
    }
    refs.push_back(ref_of(lo, hi, static_cast<std::uint32_t>(i)));
  }
  return make_fragments(refs);
}

auto content(const SplitPlane& p) {
  return std::tuple(p.axis, p.position, p.is_planar_left, p.left_count, p.right_count, p.cost);
}

TEST(Fragment, RoundsBoxesOutwardToFloats) {
  const double third = 1.0 / 3.0;
  const Fragment f =
      make_fragments(std::vector{ref_of({third, 0.25, -1e300}, {1, third, -0.0})})[0];
  EXPECT_LT(f.lo[0], third);
  EXPECT_GT(f.hi[1], third);
  EXPECT_EQ(std::nextafter(f.lo[0], 1.0f), f.hi[1]);
  EXPECT_EQ(f.lo[1], 0.25f);
  EXPECT_EQ(f.lo[2], -std::numeric_limits<float>::infinity());
  EXPECT_FALSE(std::signbit(f.hi[2]));
}

TEST(Sweep, ReproducesThePublishedExampleOfThreeObjects) {
  const std::vector<PrimRef> refs{ref_of({4, 0, 0}, {7, 10, 10}), ref_of({-2, 0, 0}, {8, 10, 10}),
                                  ref_of({6, 0, 0}, {12, 10, 10})};
  const std::vector<Fragment> fragments = make_fragments(refs);
  const SweepLists lists = make_sweep_lists(fragments, Executor());
  // The example tests an object that the plane cuts once per ray: its share of the plane is taken
  // off.
  std::vector<std::pair<float, double>> published;
  for_each_sweep_plane(lists[0], 3, [&](float p, const PlaneCounts& n) {
    if (p <= 0.0f || p >= 10.0f) return;
    const double x = static_cast<double>(p), cut = static_cast<double>(n.left + n.right) - 3.0;
    const double left = sah_split_cost({0.0, 1.0}, (100 + 20 * x) / 300, n.left, 0.0, 0);
    const double right = sah_split_cost({0.0, 1.0}, 0.0, 0, (300 - 20 * x) / 300, n.right);
    published.emplace_back(p, left + right - cut / 3);
  });
  ASSERT_EQ(published.size(), 4u);
  const double expected[] = {2.4667, 2.6, 2.8, 2.7333};
  const float at[] = {4, 6, 7, 8};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(published[i].first, at[i]);
    EXPECT_NEAR(published[i].second, expected[i], 1e-4);
  }
  const PlaneCost cost({{0, 0, 0}, {10, 10, 10}}, kUnitCost, 0.0);
  const SplitPlane best = find_plane_by_sweep(lists, 3, cost, Executor());
  EXPECT_EQ(best.axis, 0u);
  EXPECT_EQ(best.position, 4.0f);
}

// Strands of length L in a unit cube, a share L / (L + 1) of them cut by its middle plane:
// 1000 (2/3 + 1/3 L / (L + 1)) tests, a cut strand tested once per ray.
TEST(Sweep, GivesThePublishedTestsForStrandsOfAllLengths) {
  const std::pair<std::size_t, double> table[] = {
      {0, 667}, {90, 697}, {334, 778}, {500, 833}, {800, 933}};
  for (const auto& [cut, tests] : table) {
    SplitPlane best;
    const PlaneCost cost({{0, 0, 0}, {1, 1, 1}}, {0.0, 1.0}, 0.0);
    const std::size_t side = (1000 + cut) / 2;
    cost.offer(0, 0.5f, {side, 0, side}, best);
    EXPECT_NEAR(best.cost - static_cast<double>(cut) / 3.0, tests, 1.0);
  }
}

/// Points spread evenly over [0, reach] of the x axis, in the middle of a unit cube otherwise.
std::vector<Fragment> points_up_to(double reach) {
  std::vector<PrimRef> refs;
  for (int i = 0; i < 1000; ++i) {
    const Vec3d p{reach * (i + 0.5) / 1000, 0.5, 0.5};
    refs.push_back(ref_of(p, p));
  }
  return make_fragments(refs);
}

// Content up to R of the side: the best plane lies at R for R <= 1/3, else at (R + 1) / 4.
TEST(Sweep, CutsEmptySpaceWhereTheAnalysisSays) {
  const PlaneCost cost({{0, 0, 0}, {1, 1, 1}}, {0.0, 1.0}, 0.0);
  const std::tuple<double, double, double> table[] = {{0.2, 0.2, 466.7}, {0.5, 0.375, 625.0}};
  for (const auto& [reach, at, tests] : table) {
    const std::vector<Fragment> points = points_up_to(reach);
    SplitPlane best;
    for_each_sweep_plane(make_sweep_lists(points, Executor())[0], 1000,
                         [&](float p, const PlaneCounts& n) { cost.offer(0, p, n, best); });
    EXPECT_NEAR(best.position, at, 1e-2);
    EXPECT_NEAR(best.cost, tests, 1.0);
  }
}

TEST(Median, CostsAsMuchAsTheMiddleForEvenPoints) {
  const PlaneCost cost({{0, 0, 0}, {1, 1, 1}}, {0.0, 1.0}, 0.0);
  const std::vector<Fragment> points = points_up_to(1.0);
  EXPECT_NEAR(find_plane_at_middle(points, cost, 0).cost, 666.7, 0.1);
  EXPECT_NEAR(find_plane_at_median(points, cost, 0).cost, 666.7, 1.0);
  const std::vector<Fragment> uneven = points_up_to(0.2);
  EXPECT_EQ(find_plane_at_middle(uneven, cost, 0).position, 0.5f);
  EXPECT_NEAR(find_plane_at_median(uneven, cost, 0).position, 0.1f, 1e-3f);
}

TEST(Median, FindsNoPlaneThatDividesNothing) {
  const std::vector<PrimRef> refs(5, ref_of({0, 0, 0}, {1, 1, 1}));
  const PlaneCost cost({{0, 0, 0}, {1, 1, 1}}, kUnitCost, 0.0);
  EXPECT_FALSE(find_plane_at_middle(make_fragments(refs), cost, 0).is_found());
  EXPECT_FALSE(find_plane_at_median(make_fragments(refs), cost, 2).is_found());
  EXPECT_FALSE(find_plane_at_median({}, cost, 0).is_found());
}

TEST(Sweep, FindsThePlaneThatCountingEveryFragmentFinds) {
  Rng rng(7);
  for (int round = 0; round < 60; ++round) {
    const std::vector<Fragment> fragments = lattice_fragments(rng, 1 + rng.below(60));
    const PlaneCost cost({{0, 0, 0}, {8, 8, 8}}, kUnitCost, round % 2 * 0.2);
    const SweepLists lists = make_sweep_lists(fragments, Executor());
    EXPECT_EQ(content(find_plane_by_sweep(lists, fragments.size(), cost, Executor())),
              content(find_plane_by_counting(fragments, cost, Executor())));
  }
}

TEST(Sweep, IsNotBeatenByDenseSampling) {
  Rng rng(8);
  const std::vector<Fragment> fragments = lattice_fragments(rng, 40);
  const PlaneCost cost({{0, 0, 0}, {8, 8, 8}}, kUnitCost, 0.0);
  const SweepLists lists = make_sweep_lists(fragments, Executor());
  const SplitPlane best = find_plane_by_sweep(lists, fragments.size(), cost, Executor());
  SplitPlane sampled;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (int i = 1; i < 10000; ++i) {
      const float p = 8.0f * static_cast<float>(i) / 10000.0f;
      cost.offer(axis, p, count_about(fragments, axis, p), sampled);
    }
  EXPECT_GE(sampled.cost, best.cost);
}

TEST(Sweep, DividedListsAreTheListsOfTheDividedFragments) {
  Rng rng(9);
  const Aabb cell{{0, 0, 0}, {8, 8, 8}};
  for (int round = 0; round < 60; ++round) {
    const std::vector<Fragment> fragments = lattice_fragments(rng, 2 + rng.below(200));
    const SweepLists lists = make_sweep_lists(fragments, Executor());
    const SplitPlane plane =
        find_plane_by_sweep(lists, fragments.size(), PlaneCost(cell, kUnitCost, 0.0), Executor());
    ASSERT_TRUE(plane.is_found());
    const FragmentHalves halves = divide_fragments(fragments, cell, plane, {nullptr, true});
    EXPECT_EQ(halves.left.fragments.size(), plane.left_count);
    EXPECT_EQ(halves.right.fragments.size(), plane.right_count);
    for (const FragmentHalf* half : {&halves.left, &halves.right}) {
      SweepLists divided = divide_sweep_lists(lists, *half, Executor());
      SweepLists made = make_sweep_lists(half->fragments, Executor());
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_TRUE(std::is_sorted(divided[axis].begin(), divided[axis].end()));
        const auto key = [](const SweepEvent& e) { return std::pair(e.packed, e.position); };
        const auto by_key = [&](const SweepEvent& a, const SweepEvent& b) {
          return key(a) < key(b);
        };
        std::sort(divided[axis].begin(), divided[axis].end(), by_key);
        std::sort(made[axis].begin(), made[axis].end(), by_key);
        ASSERT_EQ(divided[axis].size(), made[axis].size());
        for (std::size_t i = 0; i < made[axis].size(); ++i)
          EXPECT_EQ(key(divided[axis][i]), key(made[axis][i]));
      }
    }
  }
}

TEST(Divide, PutsFragmentsWithinThePlaneOnTheSideItNames) {
  const std::vector<PrimRef> refs{ref_of({4, 0, 0}, {4, 8, 8}, 0), ref_of({2, 0, 0}, {4, 8, 8}, 1),
                                  ref_of({4, 0, 0}, {6, 8, 8}, 2), ref_of({3, 0, 0}, {5, 8, 8}, 3)};
  SplitPlane plane;
  plane.position = 4.0f;
  for (const bool left : {true, false}) {
    plane.is_planar_left = left;
    const FragmentHalves halves =
        divide_fragments(make_fragments(refs), {{0, 0, 0}, {8, 8, 8}}, plane, {nullptr, false});
    EXPECT_EQ(halves.left.fragments.size(), left ? 3u : 2u);
    EXPECT_EQ(halves.right.fragments.size(), left ? 2u : 3u);
    EXPECT_EQ(halves.left.fragments.back().reference, 3u);
    EXPECT_EQ(halves.left.fragments.back().hi[0], 4.0f);
    EXPECT_EQ(halves.right.fragments.back().lo[0], 4.0f);
  }
}

TEST(Bins, CountTheirBordersExactly) {
  Rng rng(10);
  for (int round = 0; round < 60; ++round) {
    const std::vector<Fragment> fragments = lattice_fragments(rng, 1 + rng.below(60));
    const PlaneCost cost({{0, 0, 0}, {8, 8, 8}}, kUnitCost, 0.0);
    SplitPlane expected;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (int j = 1; j < 16; ++j) {
        const float p = 0.5f * static_cast<float>(j);
        cost.offer(axis, p, count_about(fragments, axis, p), expected);
      }
    EXPECT_EQ(content(find_plane_by_bins(fragments, cost, 16, Executor()).plane),
              content(expected));
  }
}

TEST(Bins, FindNoPlaneInACellWithoutRoomForOne) {
  const std::vector<PrimRef> refs{ref_of({1, 1, 1}, {1, 1, 1})};
  const PlaneCost cost({{1, 1, 1}, {1, 1, 1}}, kUnitCost, 0.0);
  EXPECT_FALSE(find_plane_by_bins(make_fragments(refs), cost, 8, Executor()).plane.is_found());
}

TEST(MemoryMeter, RefusesWhatPassesTheLimitAndForgetsWhatIsReturned) {
  BuildContext context;
  context.memory_limit = 100;
  MemoryMeter meter(context, "test");
  MemoryLease lease(meter, 60);
  { const MemoryLease second(meter, 40); }
  EXPECT_NO_THROW(MemoryLease(meter, 40));
  lease = MemoryLease();
  EXPECT_NO_THROW(MemoryLease(meter, 100));
  EXPECT_THROW(MemoryLease(meter, 101), Error);
}

}  // namespace
}  // namespace strahl
