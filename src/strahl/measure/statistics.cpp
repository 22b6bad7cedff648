#include <algorithm>
#include <cmath>

#include <strahl/base/rng.h>
#include <strahl/measure/statistics.h>

namespace strahl {
namespace {

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
  return bootstrap(ratios, [](const std::vector<double>& values) { return median(values); });
}

Estimate geometric_mean(std::span<const double> ratios) {
  return bootstrap({ratios.begin(), ratios.end()}, [](const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += std::log(value);
    return std::exp(sum / static_cast<double>(values.size()));
  });
}

}  // namespace strahl
