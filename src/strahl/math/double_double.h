// math/double_double.h - sums of two doubles: about 106 bits, between double and exact expansions.
//
// Paper:      [Dekker1971]. Invariants: |low| <= ulp(high) / 2.
// Errors:     with U = 2^-104: a difference of two doubles is exact; a sum is off by at most
//             U (|a| + |b|), a product by at most U |a b|. So a polynomial whose monomials sum up
//             to at most P in magnitude, evaluated in at most 16 roundings per monomial, is off by
//             less than 2^-99 P.
// Thread safety: values. Needs round-to-nearest and the range of math/expansion.h.
#pragma once

#include <optional>

#include <strahl/math/expansion.h>
#include <strahl/math/vec3.h>

namespace strahl {

struct DoubleDouble {
  double high = 0.0, low = 0.0;
};

/// a - b, exactly.
inline DoubleDouble wide_difference(double a, double b) {
  const TwoTerms d = two_sum(a, -b);
  return {d.high, d.low};
}
inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const TwoTerms s = two_sum(a.high, b.high);
  const TwoTerms r = two_sum(s.high, s.low + (a.low + b.low));
  return {r.high, r.low};
}
inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
  return a + DoubleDouble{-b.high, -b.low};
}
inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const TwoTerms p = two_product(a.high, b.high);
  const TwoTerms r = two_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
  return {r.high, r.low};
}

/// Three of them.
struct WideVec {
  DoubleDouble x, y, z;
};
inline WideVec wide(const Vec3d& v) { return {{v.x, 0}, {v.y, 0}, {v.z, 0}}; }
inline WideVec wide_difference(const Vec3d& a, const Vec3d& b) {
  return {wide_difference(a.x, b.x), wide_difference(a.y, b.y), wide_difference(a.z, b.z)};
}
inline WideVec cross(const WideVec& a, const WideVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline DoubleDouble dot(const WideVec& a, const WideVec& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

/// The double nearest to the true value if `v`, known to be off by at most `error`, decides it.
inline std::optional<double> certain_rounding(const DoubleDouble& v, double error) {
  const double below = v.high + (v.low - error), above = v.high + (v.low + error);
  if (below == above) return below;
  return std::nullopt;
}

}  // namespace strahl
