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

/// The median of the ratios a[i] / b[i] of paired measurements, its interval by the percentile
/// bootstrap [Efron1979], 2,000 resamples, reproducible. As many of a as of b, at least one.
Estimate median_ratio(std::span<const double> a, std::span<const double> b);

/// The geometric mean of ratios of independent scenes, its interval by the same bootstrap over
/// scenes. At least one; all positive.
Estimate geometric_mean(std::span<const double> ratios);

}  // namespace strahl
