#include <algorithm>
#include <cmath>

#include <strahl/base/rng.h>
#include <strahl/measure/statistics.h>

namespace strahl {
namespace {

/// The greatest k so that the median of a population lies outside the k-th least to the k-th
/// greatest of n values in at most 5 of 100 experiments; 1 where there is none.
std::size_t median_rank(std::size_t n) {
  double chance = std::exp2(-static_cast<double>(n)), outside = chance;
  std::size_t k = 1;
  for (; k < n / 2; ++k) {
    chance *= static_cast<double>(n - k + 1) / static_cast<double>(k);
    outside += chance;
    if (2.0 * outside > 0.05) break;
  }
  return k;
}

/// A statistic of the values with its interval.
template <class Statistic>
Estimate bootstrap(const std::vector<double>& values, Statistic statistic) {
  constexpr int kResamples = 2000;
  Rng rng(2026);
  std::vector<double> estimates, resample(values.size());
  for (int r = 0; r < kResamples; ++r) {
    for (double& value : resample)
      value = values[rng.below(static_cast<std::uint32_t>(values.size()))];
    estimates.push_back(statistic(resample));
  }
  return {statistic(values), quantile(estimates, 0.025), quantile(estimates, 0.975)};
}

}  // namespace

double quantile(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  const double at = p * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - std::floor(at)) * (values[above] - values[below]);
}

Estimate median_ratio(std::span<const double> a, std::span<const double> b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
  std::sort(ratios.begin(), ratios.end());
  const std::size_t k = median_rank(ratios.size());
  return {median(ratios), ratios[k - 1], ratios[ratios.size() - k]};
}

Estimate geometric_mean(std::span<const double> ratios) {
  return bootstrap({ratios.begin(), ratios.end()}, [](const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += std::log(value);
    return std::exp(sum / static_cast<double>(values.size()));
  });
}

}  // namespace strahl
