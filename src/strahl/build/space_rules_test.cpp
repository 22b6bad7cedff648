#include <algorithm>
#include <cmath>
#include <tests/support/mesh_maker.h>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/build/coverage.h>
#include <strahl/build/space_bins.h>
#include <strahl/build/space_empty.h>
#include <strahl/build/space_naive.h>
#include <strahl/build/space_sweep.h>
#include <strahl/build/space_walls.h>

namespace strahl {
namespace {

using test::MeshMaker;

/// Boxes of all sizes in the unit cube; some are planar, some share ends.
std::vector<Fragment> boxes(Rng& rng, std::size_t count, double size) {
  std::vector<PrimRef> refs;
  for (std::size_t i = 0; i < count; ++i) {
    PrimRef ref{{}, static_cast<std::uint32_t>(i)};
    Vec3d lo, hi;
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis] = std::floor(rng.uniform() * 64) / 64 * 0.9;
      hi[axis] =
          rng.below(4) == 0 ? lo[axis] : lo[axis] + rng.uniform() * std::min(size, 1 - lo[axis]);
    }
    ref.box = {lo, hi};
    refs.push_back(ref);
  }
  return make_fragments(refs);
}

const Aabb kUnitCube{{0, 0, 0}, {1, 1, 1}};

// The bound is proven for every plane, so neither the exact sweep nor any position may beat it.
TEST(BinningLoss, BoundsWhatTheExactSweepGains) {
  Rng rng(1);
  for (int round = 0; round < 200; ++round) {
    const auto fragments = boxes(rng, 1 + rng.below(200), round % 2 == 0 ? 0.1 : 0.9);
    const PlaneCost cost(kUnitCube, {1.0, 0.7}, round % 3 == 0 ? 0.8 : 0.1);
    const int bins = 2 + static_cast<int>(rng.below(30));
    const BinnedPlane binned = find_plane_by_bins(fragments, cost, bins, Executor());
    const SplitPlane exact = find_plane_by_sweep(make_sweep_lists(fragments, Executor()),
                                                 fragments.size(), cost, Executor());
    ASSERT_LE(binned.least_cost, binned.plane.cost);
    ASSERT_LE(binned.least_cost, exact.cost * (1 + 1e-12)) << round;
  }
}

TEST(BinningLoss, BoundsPlanesAtAnyPosition) {
  Rng rng(2);
  for (int round = 0; round < 20; ++round) {
    const auto fragments = boxes(rng, 60, 0.3);
    const PlaneCost cost(kUnitCube, {1.0, 1.0}, 0.5);
    const double least = find_plane_by_bins(fragments, cost, 8, Executor()).least_cost;
    SplitPlane any;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (int i = 1; i < 1000; ++i) {
        const float p = static_cast<float>(i) / 1000.0f;
        cost.offer(axis, p, count_about(fragments, axis, p), any);
      }
    ASSERT_LE(least, any.cost * (1 + 1e-12));
  }
}

TEST(BinningLoss, ShrinksWithTheBins) {
  Rng rng(3);
  const auto fragments = boxes(rng, 5000, 0.02);
  const PlaneCost cost(kUnitCube, {1.0, 1.0}, 0.0);
  double last = 1.0;
  for (const int bins : {4, 16, 64, 256}) {
    const BinnedPlane binned = find_plane_by_bins(fragments, cost, bins, Executor());
    const double loss = 1.0 - binned.least_cost / binned.plane.cost;
    EXPECT_GE(loss, 0.0);
    EXPECT_LT(loss, 0.6 * last) << bins;
    last = loss;
  }
}

TEST(EmptyCut, TakesTheWidestEmptySide) {
  const std::vector<PrimRef> refs{{{{0.25, 0.125, 0.5}, {0.5, 0.5, 0.75}}, 0},
                                  {{{0.25, 0.5, 0.5}, {0.25, 0.625, 0.5}}, 1}};
  const auto fragments = make_fragments(refs);
  const PlaneCost cost(kUnitCube, {1.0, 1.0}, 0.0);
  for (const double least : {0.01, 0.5}) {
    const SplitPlane plane = find_empty_cut(fragments, cost, least);
    EXPECT_EQ(plane.axis, 0u);  // half of x and half of z are empty: the lower axis
    EXPECT_EQ(plane.position, 0.5f);
    EXPECT_EQ(plane.left_count, 2u);
    EXPECT_EQ(plane.right_count, 0u);
    EXPECT_EQ(plane.cost, cost.of(0, 0.5, 2, 0));
  }
  EXPECT_FALSE(find_empty_cut(fragments, cost, 0.51).is_found());
  EXPECT_FALSE(find_empty_cut({}, cost, 0.01).is_found());
}

TEST(EmptyCut, PutsWhatLiesInThePlaneToTheContent) {
  const std::vector<PrimRef> refs{{{{0.5, 0, 0}, {0.5, 1, 1}}, 0}, {{{0.75, 0, 0}, {1, 1, 1}}, 1}};
  const auto fragments = make_fragments(refs);
  const SplitPlane plane = find_empty_cut(fragments, {kUnitCube, {1.0, 1.0}, 0.0}, 0.1);
  EXPECT_EQ(plane.position, 0.5f);
  const FragmentHalves halves = divide_fragments(fragments, kUnitCube, plane, {nullptr, false});
  EXPECT_TRUE(halves.left.fragments.empty());
  EXPECT_EQ(halves.right.fragments.size(), 2u);
}

TEST(Coverage, TwoTrianglesCoverTheirSquareInAnyOrderOfCorners) {
  const PlanarPoint a{0, 0}, b{1, 0}, c{1, 1}, d{0, 1};
  OpenArea open;
  open.cover({a, b, c});
  EXPECT_FALSE(open.is_covered());
  EXPECT_NEAR(open.area(), 0.5, 1e-15);
  open.cover({a, b, c});
  EXPECT_NEAR(open.area(), 0.5, 1e-15);
  open.cover({a, d, c});
  EXPECT_TRUE(open.is_covered());
}

TEST(Coverage, LeavesTheAreaThatSamplingFinds) {
  Rng rng(4);
  std::vector<std::array<PlanarPoint, 3>> triangles(12);
  OpenArea open;
  for (auto& t : triangles) {
    for (PlanarPoint& p : t) p = {rng.uniform(-0.3, 1.3), rng.uniform(-0.3, 1.3)};
    open.cover(t);
  }
  const auto contains = [](const std::array<PlanarPoint, 3>& t, double u, double v) {
    int signs = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const PlanarPoint &a = t[i], &b = t[(i + 1) % 3];
      signs += (b.u - a.u) * (v - a.v) - (b.v - a.v) * (u - a.u) > 0 ? 1 : -1;
    }
    return signs == 3 || signs == -3;
  };
  int uncovered = 0;
  for (int i = 0; i < 400; ++i)
    for (int j = 0; j < 400; ++j)
      uncovered += std::none_of(triangles.begin(), triangles.end(), [&](const auto& t) {
        return contains(t, (i + 0.5) / 400, (j + 0.5) / 400);
      });
  EXPECT_GT(uncovered, 1000);
  EXPECT_NEAR(open.area(), uncovered / 160000.0, 2e-3);
}

/// A wall across a unit room of n x n tiles at x, one of them missing on request, and some content.
test::ScenePtr room(double x, int n, bool has_hole) {
  MeshMaker mesh = test::soup(100, 0.05, 5);
  const double side = 1.0 / n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (!has_hole || i != 1 || j != 0)
        mesh.quad({x, i * side, j * side}, {0, side, 0}, {0, 0, side});
  return mesh.scene();
}

SplitPlane wall_of(const Scene& scene, const Aabb& cell) {
  std::vector<PrimRef> refs;
  for (std::uint32_t i = 0; i < scene.size(); ++i) refs.push_back({scene.bounds(i), i});
  return find_covered_plane(make_fragments(refs), scene, {cell, {1.0, 1.0}, 0.0});
}

TEST(Walls, AreFoundWhereTheyCoverTheWholeCrossSection) {
  for (const int tiles : {1, 2, 5})
    for (const double x : {0.3125, 0.7, 1.0 / 3.0}) {  // two of them lie between floats
      const auto scene = room(x, tiles, false);
      const SplitPlane plane = wall_of(*scene, kUnitCube);
      ASSERT_TRUE(plane.is_found()) << tiles << ' ' << x;
      EXPECT_EQ(plane.axis, 0u);
      EXPECT_NEAR(plane.position, x, 1e-7);
      const Scene& s = *scene;
      std::vector<PrimRef> refs;
      for (std::uint32_t i = 0; i < s.size(); ++i) refs.push_back({s.bounds(i), i});
      const auto halves =
          divide_fragments(make_fragments(refs), kUnitCube, plane, {nullptr, false});
      const auto& smaller = x < 0.5 ? halves.left : halves.right;
      EXPECT_EQ(std::count_if(smaller.fragments.begin(), smaller.fragments.end(),
                              [](const Fragment& f) { return f.reference >= 100; }),
                2 * tiles * tiles);
      EXPECT_LE(halves.left.fragments.size(), plane.left_count);
    }
}

TEST(Walls, WithADoorAreNone) {
  EXPECT_FALSE(wall_of(*room(0.3125, 5, true), kUnitCube).is_found());
  EXPECT_FALSE(wall_of(*room(0.7, 2, true), kUnitCube).is_found());
}

TEST(Walls, OnTheRimOfTheCellOrTooSmallAreNone) {
  const auto scene = room(0.25, 2, false);
  EXPECT_FALSE(wall_of(*scene, {{0.25, 0, 0}, {1, 1, 1}}).is_found());
  EXPECT_FALSE(wall_of(*scene, {{0, 0, 0}, {1, 1.001, 1}}).is_found());
  EXPECT_TRUE(wall_of(*scene, {{0, 0.25, 0.25}, {1, 0.5, 1}}).is_found());  // larger than it
}

TEST(Walls, OfSpheresAreNone) {
  SceneData data;
  Geometry spheres;
  spheres.kind = PrimitiveKind::sphere;
  spheres.spheres.assign(10, {{0.5, 0.5, 0.5}, 1e-12});
  data.geometries.push_back(spheres);
  EXPECT_FALSE(wall_of(Scene(std::move(data)), kUnitCube).is_found());
}

TEST(Slices, HoldTheCheapestPlaneFirst) {
  Rng rng(6);
  for (int round = 0; round < 50; ++round) {
    const auto fragments = boxes(rng, 2 + rng.below(100), 0.4);
    const PlaneCost cost(kUnitCube, {1.0, 1.0}, 0.1);
    PlaneSlices slices(cost, 4);
    const SweepLists lists = make_sweep_lists(fragments, Executor());
    offer_ends(lists, fragments.size(), slices, Executor());
    const auto found = slices.found();
    ASSERT_LE(found.size(), 12u);
    const SplitPlane best = find_plane_by_sweep(lists, fragments.size(), cost, Executor());
    const auto first = std::min_element(
        found.begin(), found.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
    EXPECT_EQ(first->cost, best.cost);
    EXPECT_EQ(first->axis, best.axis);
    EXPECT_EQ(first->position, best.position);
  }
}

}  // namespace
}  // namespace strahl
