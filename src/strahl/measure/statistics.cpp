#include <algorithm>
#include <cmath>

#include <strahl/base/rng.h>
#include <strahl/measure/statistics.h>

namespace strahl {

double quantile(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  const double at = p * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - std::floor(at)) * (values[above] - values[below]);
}

Estimate median_ratio(std::span<const double> a, std::span<const double> b) {
  constexpr int kResamples = 2000;
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
  Rng rng(2026);
  std::vector<double> medians, resample(ratios.size());
  for (int r = 0; r < kResamples; ++r) {
    for (double& value : resample)
      value = ratios[rng.below(static_cast<std::uint32_t>(ratios.size()))];
    medians.push_back(median(resample));
  }
  return {median(ratios), quantile(medians, 0.025), quantile(medians, 0.975)};
}

}  // namespace strahl
