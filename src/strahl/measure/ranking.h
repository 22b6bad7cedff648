// measure/ranking.h - which of several competitors are better over many scenes, and by how many
// rays a dearer build pays.
//
// Source: ranks averaged over scenes and tested against all being alike [Friedman1937]; two mean
//   ranks differ at the 5 % level where they are further apart than the critical difference
//   [Nemenyi1963], whose quantiles of the studentized range are integrated here as its definition
//   says. Use of both: [Demsar2006].
// Thread safety: pure functions.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <strahl/measure/statistics.h>

namespace strahl {

struct Ranking {
  std::size_t scenes = 0;
  std::vector<double> mean_ranks;    ///< per competitor; 1 is best; ties share their ranks
  double chi_square = 0.0;           ///< Friedman's statistic, corrected for ties
  double p_value = 1.0;              ///< of all being alike; chi-square approximation
  double critical_difference = 0.0;  ///< of two mean ranks, level 5 %
};

/// Ranks competitors by cost, lower is better. Two competitors and one scene at least.
/// @param costs shape (scenes, competitors)
Ranking rank_by_cost(std::span<const std::vector<double>> costs);

/// What two competitors cost: `build` once, `per_ray` for each ray; seconds.
struct CostLine {
  double build, per_ray;
};

/// The number of rays from which on `a` is cheaper in total than `b` [HapalaKarlikHavran2011]: 0
/// when it always is, nothing when it never is.
std::optional<double> break_even(const CostLine& a, const CostLine& b);

/// Chance that chi-square with `degrees` degrees of freedom exceeds x >= 0. degrees >= 1.
double chi_square_tail(double x, std::size_t degrees);

/// The 95 % quantile of the range of n standard normal numbers, n >= 2, to about 1e-6.
double studentized_range_95(std::size_t n);

}  // namespace strahl
