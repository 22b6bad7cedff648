#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/measure/statistics.h>

namespace strahl {
namespace {

TEST(Statistics, QuantilesInterpolateBetweenOrderStatistics) {
  EXPECT_EQ(median({3, 1, 2}), 2.0);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(median({7}), 7.0);
  EXPECT_EQ(quantile({1, 2, 3, 4, 5}, 0.0), 1.0);
  EXPECT_EQ(quantile({1, 2, 3, 4, 5}, 1.0), 5.0);
  EXPECT_DOUBLE_EQ(quantile({1, 2, 3, 4, 5}, 0.9), 4.6);
}

TEST(Statistics, TheRatioOfPairedMeasurementsIgnoresWhatSlowsBoth) {
  // Each pair is slowed by another factor: the ratio is that of the quiet machine.
  const std::vector<double> a{2.0, 4.0, 20.0, 2.2, 6.0}, b{1.0, 2.0, 10.0, 1.1, 3.0};
  const Estimate e = median_ratio(a, b);
  EXPECT_DOUBLE_EQ(e.value, 2.0);
  EXPECT_DOUBLE_EQ(e.low, 2.0);
  EXPECT_DOUBLE_EQ(e.high, 2.0);
}

/// How many of 1,000 intervals of n skewed ratios around 1.5 hold the truth.
int times_held(int n) {
  Rng rng(5);
  int held = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<double> a, b(static_cast<std::size_t>(n), 1.0);
    // Half lie a little below, half anywhere above.
    for (int i = 0; i < n; ++i)
      a.push_back(rng.uniform() < 0.5 ? 1.5 - 0.1 * rng.uniform() : 1.5 + rng.uniform());
    const Estimate e = median_ratio(a, b);
    held += e.low <= 1.5 && 1.5 <= e.high;
    EXPECT_LE(e.low, e.value);
    EXPECT_LE(e.value, e.high);
  }
  return held;
}

TEST(Statistics, IntervalsHoldTheTruthAsOftenAsTheySay) {
  for (const int n : {6, 7, 9, 11, 20, 40}) EXPECT_GE(times_held(n), 935) << n;  // 950 +- 7
  EXPECT_NEAR(times_held(5), 937, 25);
  EXPECT_LT(times_held(40), 985);  // not by being as wide as can be
  const std::vector<double> nine{9, 1, 5, 3, 7, 2, 8, 4, 6}, ones(9, 1.0);
  EXPECT_EQ(median_ratio(nine, ones).low, 2.0);
  EXPECT_EQ(median_ratio(nine, ones).high, 8.0);
}

TEST(Statistics, TheGeometricMeanOfRatiosWeighsDoubleAndHalfAlike) {
  const Estimate e = geometric_mean(std::vector<double>{2.0, 0.5, 4.0, 0.25});
  EXPECT_DOUBLE_EQ(e.value, 1.0);
  EXPECT_LT(e.low, 1.0);
  EXPECT_GT(e.high, 1.0);
  EXPECT_GT(e.low, 0.25);
  EXPECT_LT(e.high, 4.0);
}

}  // namespace
}  // namespace strahl
