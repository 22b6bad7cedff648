#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/build/grid_resolution.h>

namespace strahl {
namespace {

Aabb box_of(const Vec3d& extent) { return {{1, 2, 3}, Vec3d{1, 2, 3} + extent}; }

std::uint64_t product(const CellPosition& n) {
  std::uint64_t all = 1;
  for (const int count : n) all *= static_cast<std::uint64_t>(count);
  return all;
}

TEST(GridResolution, WooCountsByTheLongestAxis) {
  EXPECT_EQ(grid_resolution(box_of({2, 1, 0.1}), 1000.5, GridRule::woo), (CellPosition{10, 5, 1}));
  EXPECT_EQ(grid_resolution(box_of({1, 1, 1}), 27.5, GridRule::woo), (CellPosition{3, 3, 3}));
  EXPECT_EQ(grid_resolution(box_of({0, 0, 0}), 27.5, GridRule::woo), (CellPosition{1, 1, 1}));
}

TEST(GridResolution, CubicFollowsThePublishedFormulas) {
  // round((V xs^2 / (ys zs))^(1/3)), round(sqrt(V ys / (nx zs))), round(V / (nx ny))
  EXPECT_EQ(grid_resolution(box_of({24, 24, 1.36}), 7382, GridRule::cubic),
            (CellPosition{51, 51, 3}));
  EXPECT_EQ(grid_resolution(box_of({1, 1, 1}), 1000, GridRule::cubic), (CellPosition{10, 10, 10}));
  EXPECT_EQ(grid_resolution(box_of({1, 8, 1}), 1000, GridRule::cubic), (CellPosition{5, 40, 5}));
}

TEST(GridResolution, CubicSpendsItsCellsInFlatAndStretchedBoxes) {
  for (const double thin : {0.0, 1e-200, 1e-9, 1e-4}) {
    EXPECT_EQ(grid_resolution(box_of({1, thin, 1}), 10000, GridRule::cubic),
              (CellPosition{100, 1, 100}));
    EXPECT_EQ(grid_resolution(box_of({thin, thin, 1}), 500, GridRule::cubic),
              (CellPosition{1, 1, 500}));
  }
  EXPECT_EQ(grid_resolution(box_of({0, 0, 0}), 500, GridRule::cubic), (CellPosition{1, 1, 1}));
}

TEST(GridResolution, MakesAboutAsManyCellsAsWantedForAnyBox) {
  Rng rng(1);
  for (int i = 0; i < 20000; ++i) {
    Vec3d extent;
    for (int a = 0; a < 3; ++a)
      extent[a] =
          rng.below(5) ? std::ldexp(rng.uniform(), static_cast<int>(rng.below(480)) - 239) : 0;
    const double cells = std::exp2(rng.uniform(0, 24));
    const std::uint64_t made = product(grid_resolution(box_of(extent), cells, GridRule::cubic));
    ASSERT_LE(static_cast<double>(made), 4 * cells)
        << extent.x << ' ' << extent.y << ' ' << extent.z;
    const std::uint64_t woo = product(grid_resolution(box_of(extent), cells, GridRule::woo));
    ASSERT_LE(static_cast<double>(woo), 1.001 * cells);
  }
}

TEST(LimitedResolution, KeepsToTheMostCells) {
  EXPECT_EQ(limited_resolution(box_of({1, 1, 1}), {10, 10, 10}, 1000), (CellPosition{10, 10, 10}));
  EXPECT_LE(product(limited_resolution(box_of({1, 1, 1}), {1024, 1024, 1024}, 1000)), 1000u);
  EXPECT_EQ(limited_resolution(box_of({1, 1, 1}), {1024, 7, 1024}, 1), (CellPosition{1, 1, 1}));
  EXPECT_EQ(limited_resolution(box_of({1, 1, 1}), {1024, 1, 1}, 100), (CellPosition{64, 1, 1}));
}

TEST(LimitedResolution, LeavesCellsThatDoublesCanTellApart) {
  const Aabb far{{1e12, 0, 0}, {1e12 + 0.01, 1, 1}};
  const CellPosition n = limited_resolution(far, {100, 100, 100}, 1u << 30);
  EXPECT_LT(n[0], 10);
  EXPECT_EQ(n[1], 100);
  const UniformCells cells(far, n);
  for (int i = 0; i < n[0]; ++i) EXPECT_LT(cells.plane(0, i), cells.plane(0, i + 1));
  EXPECT_EQ(limited_resolution({{0, 0, 0}, {0, 0, 1}}, {9, 9, 9}, 999), (CellPosition{1, 1, 9}));
}

}  // namespace
}  // namespace strahl
