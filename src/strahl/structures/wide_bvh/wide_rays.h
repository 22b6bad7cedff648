// structures/wide_bvh/wide_rays.h - a block of rays as the kernels see them, one row per number.
//
// Rows, so that rays are made ready by vectors, a ray per lane (wide_prepare-inl.h); a kernel takes
// the constants of one ray by broadcasts from memory.
// What the numbers are and why they bound what is exact: wide_ray.h.
#pragma once

#include <cstdint>

namespace strahl {

inline constexpr std::uint32_t kWideBlock = 64;  ///< rays

/// Rows are aligned for full vectors. Not initialised: only the rays put into it are there.
struct WideRays {
  using Row = float[kWideBlock];

  alignas(64) Row org[3];
  Row dir[3], rcp[3], near[3], far[3];
  Row given[3];      ///< directions as given, of batches of floats only
  Row org_slack;     ///< distance to be added to |a - org| for the origin's own error
  Row t_enter;       ///< at most the frame's t of any wanted hit
  Row t_enter_sure;  ///< hits behind it are behind t_min
  Row t_blur2;       ///< twice the error of the frame's t that is not relative, rounded up
  Row upper, lower;  ///< of the answers when the traversal begins
  Row per_t;         ///< the frame's t of a t of 1, a power of two
  std::uint32_t signs[kWideBlock];  ///< bit a: dir[a] < 0
};

}  // namespace strahl
