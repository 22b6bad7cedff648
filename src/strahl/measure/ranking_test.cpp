#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/measure/ranking.h>

namespace strahl {
namespace {

TEST(Ranking, ChiSquareTailsAreThoseOfTheTables) {
  EXPECT_NEAR(chi_square_tail(3.841459, 1), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_tail(5.991465, 2), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_tail(7.814728, 3), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_tail(18.307038, 10), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_tail(30.577914, 15), 0.01, 1e-6);
  EXPECT_EQ(chi_square_tail(0.0, 4), 1.0);
}

TEST(Ranking, StudentizedRangesAreThoseOfTheTables) {
  EXPECT_NEAR(studentized_range_95(2), 2.7718, 1e-3);
  EXPECT_NEAR(studentized_range_95(3), 3.3145, 1e-3);
  EXPECT_NEAR(studentized_range_95(10), 4.4745, 1e-3);
  EXPECT_NEAR(studentized_range_95(20), 5.0117, 1e-3);
}

TEST(Ranking, OfAWorkedExample) {
  // Mean ranks by hand: 1.25, 1.75 and 3.0; 12 * 4 / (3 * 4) * (0.75^2 + 0.25^2 + 1^2) = 6.5.
  const std::vector<std::vector<double>> costs{
      {1.0, 2.0, 3.0}, {10.0, 20.0, 30.0}, {2.0, 1.0, 5.0}, {0.1, 0.2, 0.9}};
  const Ranking r = rank_by_cost(costs);
  EXPECT_EQ(r.scenes, 4u);
  EXPECT_DOUBLE_EQ(r.mean_ranks[0], 1.25);
  EXPECT_DOUBLE_EQ(r.mean_ranks[1], 1.75);
  EXPECT_DOUBLE_EQ(r.mean_ranks[2], 3.0);
  EXPECT_DOUBLE_EQ(r.chi_square, 6.5);
  EXPECT_NEAR(r.p_value, std::exp(-3.25), 1e-12);
  EXPECT_NEAR(r.critical_difference, 3.3145 / std::sqrt(2.0) * std::sqrt(12.0 / 24.0), 1e-3);
}

TEST(Ranking, TiesShareTheirRanksAndCorrectTheStatistic) {
  const std::vector<std::vector<double>> costs{{1.0, 1.0, 2.0}, {1.0, 1.0, 2.0}};
  const Ranking r = rank_by_cost(costs);
  EXPECT_DOUBLE_EQ(r.mean_ranks[0], 1.5);
  EXPECT_DOUBLE_EQ(r.mean_ranks[1], 1.5);
  // 12 * 2 / 12 * 1.5 = 3, over 1 - 12 / (2 * 24) = 3/4.
  EXPECT_DOUBLE_EQ(r.chi_square, 4.0);
  const Ranking alike = rank_by_cost(std::vector<std::vector<double>>{{1.0, 1.0}, {2.0, 2.0}});
  EXPECT_EQ(alike.chi_square, 0.0);
  EXPECT_EQ(alike.p_value, 1.0);
}

TEST(Ranking, ADearerBuildPaysFromTheCrossingOn) {
  EXPECT_DOUBLE_EQ(*break_even({5.0, 1.0}, {1.0, 3.0}), 2.0);
  EXPECT_EQ(break_even({1.0, 1.0}, {5.0, 3.0}), 0.0);
  EXPECT_EQ(break_even({1.0, 1.0}, {1.0, 1.0}), 0.0);
  EXPECT_FALSE(break_even({5.0, 3.0}, {1.0, 1.0}));
  EXPECT_FALSE(break_even({1.0, 3.0}, {5.0, 1.0}));  // cheaper at first, but not for good
}

}  // namespace
}  // namespace strahl
