// math/margin.h - every safety margin of the library, each with its proof.
//
// Setting: u = 2^-53. A ray is o + t*d in doubles; a filter plane p (box side, split plane, cell
// border) is a double; its parameter is computed as fl(fl(p - o) * fl(1 / d)), three roundings,
// so it is (p - o) / d * (1 + e), |e| <= gamma(3) < 2^-51. Coordinates are 0 or of magnitude
// 2^-240 .. 2^240 (float inputs: 2^-149 .. 2^128), so differences are 0 or at least 2^-293 and
// nothing overflows or underflows. Margins are therefore purely relative.
//
// kPlane: two computed plane parameters s, t stand for true values within 2^-51 of them each, so
//   true(s) <= true(t) implies s <= t + 2^-50 * |t| (+ second order), rounded up to 2^-49.
// kHit: a canonical t of a triangle is within 2^-40 of the true one (docs/semantics.md) and is
//   compared with computed plane parameters: 2^-40 + 2^-51 + roundings < 2^-39.
// Curved primitives clamp t into the computed slab interval of their own box. Rounding is
//   monotone, so computed plane parameters of any enclosing box enclose it: no margin is needed,
//   and those below do no harm.
#pragma once

#include <cmath>

namespace strahl {

inline constexpr double kPlaneMargin = 0x1p-49;
inline constexpr double kHitMargin = 0x1p-39;

/// t lowered by a relative margin; NaN stays NaN, infinities stay.
inline double lowered(double t, double margin) {
  return std::isinf(t) ? t : t - std::abs(t) * margin;
}
/// t raised by a relative margin.
inline double raised(double t, double margin) {
  return std::isinf(t) ? t : t + std::abs(t) * margin;
}

/// Whether a subtree entered at t_enter >= 0 may still hold a hit at t_max or before (ties kept).
inline bool may_hit_before(double t_enter, double t_max) {
  return t_enter * (1.0 - kHitMargin) <= t_max;
}

}  // namespace strahl
