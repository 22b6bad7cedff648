#include <cmath>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/math/uniform_cells.h>

namespace strahl {
namespace {

UniformCells cells_along_x(double lo, double hi, int n) {
  return UniformCells({{lo, 0, 0}, {hi, 1, 1}}, {n, 1, 1});
}

TEST(UniformCells, CoverTheBoxForAnyNumbers) {
  Rng rng(1);
  for (int i = 0; i < 100000; ++i) {
    const double lo = std::ldexp(rng.uniform(-1, 1), static_cast<int>(rng.below(80)) - 40);
    const double hi = lo + std::ldexp(rng.uniform(), static_cast<int>(rng.below(80)) - 40);
    const int n = 1 + static_cast<int>(rng.below(1000));
    const UniformCells cells = cells_along_x(lo, hi, n);
    ASSERT_EQ(cells.plane(0, 0), lo);
    ASSERT_GE(cells.plane(0, n), hi) << std::hexfloat << lo << ' ' << hi << ' ' << n;
  }
}

TEST(UniformCells, APlaneBelongsToTheCellsOnBothSides) {
  const UniformCells cells({{0, 0, 0}, {8, 8, 8}}, {8, 8, 8});
  const double plane = cells.plane(1, 3);
  EXPECT_EQ(cells.touched(1, plane, plane), (CellRange{2, 3}));
  EXPECT_EQ(cells.touched(1, plane, std::nextafter(plane, 9)), (CellRange{2, 3}));
  EXPECT_EQ(cells.touched(1, std::nextafter(plane, 9), 4.5), (CellRange{3, 4}));
  EXPECT_EQ(cells.touched(1, 0.5, std::nextafter(plane, 0)), (CellRange{0, 2}));
  EXPECT_EQ(cells.touched(1, -5, 0), (CellRange{0, 0}));
  EXPECT_EQ(cells.touched(1, 8, 100), (CellRange{7, 7}));
  EXPECT_EQ(cells.touched(1, -5, -1).size(), 0);
  EXPECT_EQ(cells.touched(1, 9, 10).size(), 0);
}

TEST(UniformCells, FindTheSameCellsAsALookAtEveryPlane) {
  Rng rng(2);
  for (int i = 0; i < 20000; ++i) {
    const double lo = rng.below(2) ? 1e6 : rng.uniform(-1, 1), extent = 1e-3 + rng.uniform();
    const int n = 1 + static_cast<int>(rng.below(40));
    const UniformCells cells = cells_along_x(lo, lo + extent, n);
    double ends[2];
    for (double& end : ends)
      end = rng.below(2) ? cells.plane(0, static_cast<int>(rng.below(41)) % (n + 1))
                         : lo + rng.uniform(-0.1, 1.1) * extent;
    const double a = std::min(ends[0], ends[1]), b = std::max(ends[0], ends[1]);
    CellRange expected{n, -1};
    for (int c = n - 1; c >= 0; --c)
      if (cells.plane(0, c + 1) >= a) expected.first = c;
    for (int c = 0; c < n; ++c)
      if (cells.plane(0, c) <= b) expected.last = c;
    ASSERT_EQ(cells.touched(0, a, b), expected) << std::hexfloat << a << ' ' << b;
  }
}

TEST(UniformCells, AnAxisWithoutExtentHasOneFlatCell) {
  const UniformCells cells({{0, 5, 0}, {1, 5, 1}}, {4, 1, 4});
  EXPECT_EQ(cells.plane(1, 0), 5);
  EXPECT_EQ(cells.plane(1, 1), 5);
  EXPECT_EQ(cells.touched(1, 5, 5), (CellRange{0, 0}));
  EXPECT_EQ(cells.touched(1, 6, 6).size(), 0);
}

TEST(UniformCells, AreNumberedWithXFastest) {
  const UniformCells cells({{0, 0, 0}, {2, 3, 4}}, {2, 3, 4});
  EXPECT_EQ(cells.count(), 24u);
  EXPECT_EQ(cells.index({1, 0, 0}), 1u);
  EXPECT_EQ(cells.index({1, 2, 3}), 1u + 2 * 2 + 6 * 3);
  EXPECT_EQ(cells.stride(2), 6u);
  EXPECT_EQ(cells.box({1, 2, 3}).lo,
            (Vec3d{cells.plane(0, 1), cells.plane(1, 2), cells.plane(2, 3)}));
}

TEST(UniformCells, GuessesStayInsideForAnyPosition) {
  const UniformCells cells = cells_along_x(0, 1, 10);
  EXPECT_EQ(cells.guess(0, std::nan("")), 0);
  EXPECT_EQ(cells.guess(0, -Aabb::kInf), 0);
  EXPECT_EQ(cells.guess(0, Aabb::kInf), 9);
  EXPECT_EQ(cells.guess(0, 1e300), 9);
  EXPECT_EQ(cells.guess(0, 0.55), 5);
}

}  // namespace
}  // namespace strahl
