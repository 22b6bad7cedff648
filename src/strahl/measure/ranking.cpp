#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <strahl/measure/ranking.h>

namespace strahl {
namespace {

/// Ranks of one scene's costs, and the sum of t^3 - t over its groups of t ties.
struct SceneRanks {
  std::vector<double> rank;
  double ties = 0.0;
};

SceneRanks ranks_of(const std::vector<double>& costs) {
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
  SceneRanks ranks{std::vector<double>(costs.size()), 0.0};
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && costs[order[end]] == costs[order[begin]]) ++end;
    const double shared = (static_cast<double>(begin + 1) + static_cast<double>(end)) / 2;
    for (std::size_t i = begin; i < end; ++i) ranks.rank[order[i]] = shared;
    const auto tied = static_cast<double>(end - begin);
    ranks.ties += tied * tied * tied - tied;
    begin = end;
  }
  return ranks;
}

double normal_density(double z) {
  return std::exp(-z * z / 2) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
}
double normal_below(double z) { return std::erfc(-z / std::numbers::sqrt2) / 2; }

/// Chance that n standard normal numbers lie within a range of q.
double range_below(double q, std::size_t n) {
  constexpr int kSteps = 2000;  // trapezoids over +-8, exact far beyond what is asked
  constexpr double kEnd = 8.0, kStep = 2 * kEnd / kSteps;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double z = -kEnd + i * kStep;
    sum += normal_density(z) *
           std::pow(normal_below(z) - normal_below(z - q), static_cast<double>(n - 1));
  }
  return static_cast<double>(n) * sum * kStep;
}

}  // namespace

Ranking rank_by_cost(std::span<const std::vector<double>> costs) {
  const std::size_t competitors = costs.front().size();
  const auto k = static_cast<double>(competitors), n = static_cast<double>(costs.size());
  Ranking ranking{costs.size(), std::vector<double>(competitors, 0.0), 0.0, 1.0, 0.0};
  double ties = 0.0;
  for (const std::vector<double>& scene : costs) {
    const SceneRanks ranks = ranks_of(scene);
    for (std::size_t i = 0; i < competitors; ++i) ranking.mean_ranks[i] += ranks.rank[i] / n;
    ties += ranks.ties;
  }
  double spread = 0.0;
  for (const double rank : ranking.mean_ranks) spread += std::pow(rank - (k + 1) / 2, 2);
  const double untied = 1 - ties / (n * (k * k * k - k));
  if (untied > 0.0) ranking.chi_square = 12 * n / (k * (k + 1)) * spread / untied;
  ranking.p_value = chi_square_tail(ranking.chi_square, competitors - 1);
  ranking.critical_difference =
      studentized_range_95(competitors) / std::numbers::sqrt2 * std::sqrt(k * (k + 1) / (6 * n));
  return ranking;
}

std::optional<double> break_even(const CostLine& a, const CostLine& b) {
  if (a.build <= b.build) return a.per_ray <= b.per_ray ? std::optional(0.0) : std::nullopt;
  if (a.per_ray >= b.per_ray) return std::nullopt;
  return (a.build - b.build) / (b.per_ray - a.per_ray);
}

double chi_square_tail(double x, std::size_t degrees) {
  // Q(a + 1, y) = Q(a, y) + y^a e^-y / Gamma(a + 1), from Q(1, y) = e^-y or Q(1/2, y) = erfc.
  const double y = x / 2;
  const bool is_even = degrees % 2 == 0;
  double a = is_even ? 1.0 : 0.5;
  double tail = is_even ? std::exp(-y) : std::erfc(std::sqrt(y));
  for (; 2 * a < static_cast<double>(degrees); a += 1.0)
    if (y > 0.0) tail += std::exp(a * std::log(y) - y - std::lgamma(a + 1));
  return std::min(tail, 1.0);
}

double studentized_range_95(std::size_t n) {
  double low = 0.0, high = 16.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (range_below(middle, n) < 0.95 ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace strahl
