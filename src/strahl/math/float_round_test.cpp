#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/math/float_round.h>

namespace strahl {
namespace {

using Float = std::numeric_limits<float>;
using Double = std::numeric_limits<double>;

constexpr float kSmallest = Float::denorm_min();

/// The float after f; there is none after infinity.
float next(float f) { return std::nextafter(f, Float::infinity()); }

void expect_bracket(double v) {
  const float lo = float_below(v), hi = float_above(v);
  EXPECT_LE(static_cast<double>(lo), v);
  EXPECT_GE(static_cast<double>(hi), v);
  if (static_cast<double>(lo) == v)
    EXPECT_EQ(lo, hi) << v;
  else
    EXPECT_EQ(next(lo), hi) << v;
  EXPECT_TRUE(float_nearest(v) == lo || float_nearest(v) == hi) << v;
  EXPECT_FALSE(lo == 0.0f && std::signbit(lo)) << v;
  EXPECT_FALSE(hi == 0.0f && std::signbit(hi)) << v;
}

TEST(FloatRound, KeepsFloats) {
  for (const float f : {0.25f, -3.5f, kSmallest, -kSmallest, 7 * kSmallest, Float::min(),
                        Float::max(), Float::lowest(), Float::infinity(), -Float::infinity()}) {
    EXPECT_EQ(float_below(static_cast<double>(f)), f);
    EXPECT_EQ(float_above(static_cast<double>(f)), f);
    EXPECT_EQ(float_nearest(static_cast<double>(f)), f);
  }
}

TEST(FloatRound, BracketsWhatLiesBetweenFloats) {
  Rng rng(1);
  for (int i = 0; i < 20000; ++i) {
    const double v = std::ldexp(rng.uniform(-1.0, 1.0), static_cast<int>(rng.below(270)) - 145);
    expect_bracket(v);
    expect_bracket(static_cast<double>(static_cast<float>(v)));
  }
  for (const double v : {1.0 / 3.0, 0.1, -0.1, 16777217.0}) expect_bracket(v);
}

TEST(FloatRound, BracketsWhatLiesNextToAFloat) {
  for (const float f : {1.0f, -1.0f, Float::min(), -Float::min(), kSmallest, 3 * kSmallest}) {
    const auto v = static_cast<double>(f);
    EXPECT_EQ(float_below(std::nextafter(v, Double::infinity())), f);
    EXPECT_EQ(float_above(std::nextafter(v, Double::infinity())), next(f));
    EXPECT_EQ(float_above(std::nextafter(v, -Double::infinity())), f);
    EXPECT_EQ(next(float_below(std::nextafter(v, -Double::infinity()))), f);
  }
}

TEST(FloatRound, BracketsWhatIsSmallerThanEveryFloat) {
  for (const double v : {1e-300, 0x1p-150, 0x1.8p-150, 0x1p-151, Double::denorm_min()}) {
    EXPECT_EQ(float_below(v), 0.0f);
    EXPECT_EQ(float_above(v), kSmallest);
    EXPECT_EQ(float_below(-v), -kSmallest);
    EXPECT_EQ(float_above(-v), 0.0f);
    expect_bracket(v), expect_bracket(-v);
  }
}

TEST(FloatRound, NeverGivesNegativeZero) {
  for (const double v : {0.0, -0.0, -1e-300, -0x1p-150}) {
    EXPECT_FALSE(std::signbit(float_above(v))) << v;
    expect_bracket(v);
  }
  EXPECT_FALSE(std::signbit(float_below(-0.0)));
  EXPECT_FALSE(std::signbit(float_nearest(-1e-300)));
}

TEST(FloatRound, IsInfiniteOnlyOutwardBeyondTheLargestFloat) {
  const auto largest = static_cast<double>(Float::max());
  for (const double v : {std::nextafter(largest, Double::infinity()), 3.5e38, 1e300}) {
    EXPECT_EQ(float_below(v), Float::max());
    EXPECT_EQ(float_above(v), Float::infinity());
    EXPECT_EQ(float_above(-v), Float::lowest());
    EXPECT_EQ(float_below(-v), -Float::infinity());
  }
  expect_bracket(std::nextafter(largest, 0.0));
}

/// Two numbers that an optimiser may treat at once; not inlined, so that it sees nothing else.
struct Pair {
  double x, y;
};
[[gnu::noinline]] Pair through_floats(Pair p) {
  const auto x = static_cast<float>(p.x), y = static_cast<float>(p.y);
  return {static_cast<double>(x), static_cast<double>(y)};
}

TEST(FloatRound, IsNotOptimisedAway) {
  // g++ 12 does without -fno-tree-slp-vectorize (docs/adr/0007).
  volatile double x = 0.1, y = 0.2;  // nothing is known of them
  const Pair p = through_floats({x, y});
  EXPECT_NE(p.x, 0.1);
  EXPECT_NE(p.y, 0.2);
}

TEST(FloatRound, PassesNaNOn) {
  EXPECT_TRUE(std::isnan(float_below(Double::quiet_NaN())));
  EXPECT_TRUE(std::isnan(float_above(Double::quiet_NaN())));
}

}  // namespace
}  // namespace strahl
