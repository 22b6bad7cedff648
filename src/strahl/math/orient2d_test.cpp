// math/orient2d_test.cpp - orient2d against points whose side is known by construction.
#include <cmath>

#include <gtest/gtest.h>

#include <strahl/math/orient2d.h>

namespace strahl {
namespace {

TEST(Orient2d, LeftRightAndCollinear) {
  EXPECT_EQ(orient2d({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(orient2d({0, 0}, {0, 1}, {1, 0}), -1);
  EXPECT_EQ(orient2d({0, 0}, {1, 1}, {3, 3}), 0);
  EXPECT_EQ(orient2d({1, 2}, {1, 2}, {3, 3}), 0);
}

TEST(Orient2d, SeesOneUnitInTheLastPlaceAcrossADiagonal) {
  // On the line y = x by construction; moved by one unit in the last place it leaves the line.
  const Point2 a{12, 12}, b{24, 24};
  for (double x = 0.5; x < 0.5 + 0x1p-40; x += 0x1p-45) {
    EXPECT_EQ(orient2d(a, b, {x, x}), 0);
    EXPECT_EQ(orient2d(a, b, {x, std::nextafter(x, 1.0)}), 1);
    EXPECT_EQ(orient2d(a, b, {x, std::nextafter(x, 0.0)}), -1);
  }
}

TEST(Orient2d, IsExactWhenDifferencesRound) {
  // b - a rounds, so that the floating-point determinant is 0; the true sign is that of 2^-240.
  const Point2 a{-1, 0}, b{1, 0x1p-240};
  EXPECT_EQ(orient2d(a, b, {0x1p-240, 0x1p-241}), -1);
  EXPECT_EQ(orient2d(a, b, {-0x1p-240, 0x1p-241}), 1);
  EXPECT_EQ(orient2d(a, b, {0, 0x1p-241}), 0);
}

TEST(Orient2d, IsAntisymmetricAndCyclic) {
  const Point2 a{0.1, 0.1}, b{0.3, 0.3}, c{0.7, 0.7};
  const int side = orient2d(a, b, c);
  EXPECT_EQ(orient2d(b, c, a), side);
  EXPECT_EQ(orient2d(c, a, b), side);
  EXPECT_EQ(orient2d(b, a, c), -side);
}

TEST(Orient2d, HoldsAtTheEndsOfTheCoordinateRange) {
  EXPECT_EQ(orient2d({0, 0}, {0x1p240, 0x1p-240}, {0x1p240, 0}), -1);
  EXPECT_EQ(orient2d({0, 0}, {0x1p-240, 0}, {0, 0x1p-240}), 1);
}

}  // namespace
}  // namespace strahl
