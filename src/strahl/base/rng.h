// base/rng.h - a small seeded random generator with the same numbers on every machine.
//
// Paper:    [ONeill2014], PCG-XSH-RR with 64-bit state and 32-bit output.
// Only integer arithmetic and exact scaling by a power of two: no libm, no std distributions (whose
// results differ between standard libraries).
// Thread safety: one object per thread; different streams of one seed are independent.
#pragma once

#include <cstdint>

namespace strahl {

class Rng {
 public:
  /// @param seed   any number; equal (seed, stream) give equal sequences
  /// @param stream selects one of 2^63 sequences; the top bit is ignored
  explicit Rng(std::uint64_t seed, std::uint64_t stream = 0) : increment_((stream << 1) | 1) {
    next_u32();
    state_ += seed;
    next_u32();
  }

  /// Uniform in 0..2^32-1.
  std::uint32_t next_u32() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005u + increment_;
    const auto mixed = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
    const auto turn = static_cast<std::uint32_t>(old >> 59);
    return (mixed >> turn) | (mixed << ((32 - turn) & 31));
  }

  /// Uniform in 0..2^64-1; the first of two outputs is the high half.
  std::uint64_t next_u64() {
    const std::uint64_t high = next_u32();
    return (high << 32) | next_u32();
  }

  /// Uniform in [0, 1): a multiple of 2^-53.
  double uniform() { return static_cast<double>(next_u64() >> 11) * 0x1p-53; }

  /// Uniform between low and high, rounded; high itself may occur by rounding.
  double uniform(double low, double high) { return low + uniform() * (high - low); }

  /// Uniform in 0..n-1 without bias, for shuffles and choices. Requires: n > 0.
  std::uint32_t below(std::uint32_t n) {
    // Outputs below 2^32 mod n are thrown away; what remains is a whole multiple of n.
    const std::uint32_t threshold = (0u - n) % n;
    std::uint32_t draw = next_u32();
    while (draw < threshold) draw = next_u32();
    return draw % n;
  }

 private:
  std::uint64_t state_ = 0;
  std::uint64_t increment_;
};

}  // namespace strahl
