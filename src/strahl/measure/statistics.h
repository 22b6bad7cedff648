// measure/statistics.h - what repeated measurements say.
//
// Thread safety: pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace strahl {

/// The p-quantile, interpolated linearly between order statistics [HyndmanFan1996, type 7].
/// values must not be empty; 0 <= p <= 1. O(n log n).
double quantile(std::vector<double> values, double p);

inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

/// A value and the interval that holds the truth in 95 of 100 experiments.
struct Estimate {
  double value, low, high;
};

/// The median of the ratios a[i] / b[i] of paired measurements. Its interval is between two of
/// them, whatever their distribution [Thompson1936]; of fewer than six the least to the greatest,
/// which of five hold the truth in 94 of 100 experiments. As many of a as of b, at least one.
Estimate median_ratio(std::span<const double> a, std::span<const double> b);

/// The geometric mean of ratios of independent scenes, its interval by the percentile bootstrap
/// [Efron1979] over scenes, 2,000 resamples, reproducible. At least one; all positive.
Estimate geometric_mean(std::span<const double> ratios);

}  // namespace strahl
