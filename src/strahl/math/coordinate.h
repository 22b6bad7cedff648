// math/coordinate.h - the range of coordinates that exact arithmetic can take.
#pragma once

#include <cmath>

#include <strahl/math/vec3.h>

namespace strahl {

/// Magnitudes within neither overflow nor underflow in exact steps; see math/margin.h.
inline constexpr double kMinCoordinate = 0x1p-240, kMaxCoordinate = 0x1p240;

/// 0 or of a magnitude within the range; false for NaN and infinity.
inline bool is_coordinate(double v) {
  const double a = std::abs(v);
  return a == 0.0 || (a >= kMinCoordinate && a <= kMaxCoordinate);
}
inline bool is_coordinate(const Vec3d& v) {
  return is_coordinate(v.x) && is_coordinate(v.y) && is_coordinate(v.z);
}

/// Finite but no coordinate: what a mesh may not hold, while NaN and infinity only spoil triangles.
inline bool is_out_of_range(double v) { return std::isfinite(v) && !is_coordinate(v); }
inline bool is_out_of_range(const Vec3d& v) {
  return is_out_of_range(v.x) || is_out_of_range(v.y) || is_out_of_range(v.z);
}

}  // namespace strahl
