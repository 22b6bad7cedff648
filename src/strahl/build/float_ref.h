// build/float_ref.h - a primitive, or some together, as the fast builder sees them: a number and
// a box in floats.
#pragma once

#include <cstdint>

#include <strahl/math/float4.h>

namespace strahl {

/// 32 bytes: low corner, reference, high corner negated, number of primitives. Whoever makes it
/// rounds the box outward.
struct alignas(32) FloatRef {
  float lo[3];
  std::uint32_t reference;
  float minus_hi[3];
  std::uint32_t weight;

  FloatBox box() const { return {load4(lo), load4(minus_hi)}; }
  float doubled_center(int axis) const { return lo[axis] - minus_hi[axis]; }
};

}  // namespace strahl
