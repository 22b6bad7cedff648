// math/float_round.h - doubles rounded to floats in a chosen direction, so that what is stored as
// float still encloses what was computed as double.
//
// Invariants: finite input of any size gives a defined result; none is -0; floats stay as they
//   are, infinities and NaN too.
// Thread safety: pure functions.
#pragma once

#include <cmath>
#include <limits>

namespace strahl {

/// The nearest float; beyond the largest one it is infinite.
inline float float_nearest(double v) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  if (v > static_cast<double>(kLargest)) return kInfinity;
  if (v < -static_cast<double>(kLargest)) return -kInfinity;
  return static_cast<float>(v) + 0.0f;
}

/// Largest float not above v; below -FLT_MAX it is -inf.
inline float float_below(double v) {
  const float f = float_nearest(v);
  if (!(static_cast<double>(f) > v)) return f;
  return std::nextafter(f, -std::numeric_limits<float>::infinity());
}

/// Smallest float not below v; above FLT_MAX it is +inf.
inline float float_above(double v) {
  const float f = float_nearest(v);
  if (!(static_cast<double>(f) < v)) return f;
  return std::nextafter(f, std::numeric_limits<float>::infinity()) + 0.0f;
}

}  // namespace strahl
