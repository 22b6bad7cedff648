// math/float4.h - four floats at once, for builders: what every machine's compiler knows, no
// instruction set in particular.
//
// A box is a FloatBox: its low corner and its high corner negated, so that one operation, the
// lesser of each lane, bounds both. The fourth lanes mean nothing. Thread safety: pure functions.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>

#include <strahl/math/aabb.h>

namespace strahl {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

inline Float4 load4(const void* from) {
  Float4 v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
inline void store4(void* to, Float4 v) { std::memcpy(to, &v, sizeof v); }
constexpr Float4 all4(float v) { return Float4{v, v, v, v}; }

/// The lesser of each lane; b where a is NaN.
inline Float4 min4(Float4 a, Float4 b) { return a < b ? a : b; }

/// Bits of a where those of the mask are set, else 0.
inline Float4 and4(Float4 a, Int4 mask) {
  return reinterpret_cast<Float4>(reinterpret_cast<Int4>(a) & mask);
}
/// A NaN where all bits of the mask are set, else a.
inline Float4 nan_where(Float4 a, Int4 mask) {
  return reinterpret_cast<Float4>(reinterpret_cast<Int4>(a) | mask);
}

struct FloatBox {
  Float4 lo, minus_hi;

  static FloatBox empty() {
    constexpr float kInf = std::numeric_limits<float>::infinity();
    return {all4(kInf), all4(kInf)};
  }
  /// NaN in o leaves it as it is.
  void extend(const FloatBox& o) { lo = min4(o.lo, lo), minus_hi = min4(o.minus_hi, minus_hi); }
  /// High corner less low corner.
  Float4 extent() const { return -(lo + minus_hi); }
  /// Twice the middle.
  Float4 doubled_center() const { return lo - minus_hi; }
  Aabb box() const {
    return {{double{lo[0]}, double{lo[1]}, double{lo[2]}},
            {-double{minus_hi[0]}, -double{minus_hi[1]}, -double{minus_hi[2]}}};
  }
};

/// Half surface areas of three boxes; the fourth lane means nothing. Infinite for empty boxes.
inline Float4 half_areas(const FloatBox (&boxes)[3]) {
  const Float4 a = boxes[0].extent(), b = boxes[1].extent(), c = boxes[2].extent();
  const Float4 low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Float4 high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Float4 x = __builtin_shufflevector(low, c, 0, 1, 4, 4);
  const Float4 y = __builtin_shufflevector(low, c, 2, 3, 5, 5);
  const Float4 z = __builtin_shufflevector(high, c, 0, 1, 6, 6);
  return x * y + y * z + z * x;
}

/// Half the surface area of one box that is not empty.
inline float half_area(const FloatBox& box) {
  const Float4 e = box.extent();
  return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
}

}  // namespace strahl
