// math/morton.h - places of space-filling curves: 63-bit Morton codes of points in a box.
//
// Thread safety: pure functions; MortonFrame is a value.
#pragma once

#include <cstdint>

#include <strahl/math/aabb.h>

namespace strahl {

/// Two zero bits before each of the 21 low bits.
constexpr std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}

/// Bits of x, y, z in turn, x highest.
constexpr std::uint64_t morton_code(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return spread_bits(x) << 2 | spread_bits(y) << 1 | spread_bits(z);
}

/// 2^21 cells along each axis of a box that is not empty.
class MortonFrame {
 public:
  explicit MortonFrame(const Aabb& box) : lo_(box.lo), extent_(box.extent()) {}

  /// Points outside count as in the nearest cell.
  std::uint64_t code(const Vec3d& p) const {
    return morton_code(cell(p, 0), cell(p, 1), cell(p, 2));
  }

 private:
  static constexpr double kCells = 0x1p21;

  std::uint64_t cell(const Vec3d& p, int axis) const {
    if (!(extent_[axis] > 0.0)) return 0;
    const double at = (p[axis] - lo_[axis]) / extent_[axis] * kCells;
    return at > 0.0 ? static_cast<std::uint64_t>(at < kCells ? at : kCells - 1.0) : 0;
  }

  Vec3d lo_, extent_;
};

}  // namespace strahl
