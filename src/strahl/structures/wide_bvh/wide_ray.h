// structures/wide_bvh/wide_ray.h - a ray as the kernels see it: floats of the tree's frame, with
// every error of that view bounded.
//
// Scale: d = dir * 2^j with |d|^2 in [0.25, 1.0001]; t of the frame is t * per_t - start, where
// per_t
//   is a power of two. start is 0 unless the origin is far: then the frame's ray begins shortly
//   before the scene, its origin computed in doubles and off by `blur`, so that far rays are as
//   sharp as the doubles they are given in.
// Planes: the kernel computes t = p * rcp + near (or far) per plane. Let r = 1 / d, P = reach of
// the
//   frame, u = 2^-24. Roundings of rcp, product, constant and sum (the first two relative to |p r|,
//   the others to |c| and to |t| <= |p r| + |c|, c = -o r) stay below u (3 P + 2 |o|) |r|, first
//   order; so near = c - pad and far = c + pad with pad = (u (3.01 P + 2.02 |o|) + blur + widening)
//   |r| make every entry a lower and every exit an upper bound. That holds for any origin, near or
//   far. Where |d| < 2^-60, r is 2^60: entries are still lower bounds, as the ray moves less than
//   assumed; exits behind a plane that the origin has not left are at least pad 2^60 >= u 3 P 2^60,
//   more than any t within reach of the scene.
// Hits: a canonical t is within 2^-40 of the true one; `t_blur` bounds that in the frame where
// start
//   makes it absolute, plus the rounding of the change of frame. Without start it is relative and
//   part of the filter's bounds and of upper() and lower().
#pragma once

#include <cstdint>

#include <strahl/math/ray.h>
#include <strahl/structures/wide_bvh/wide_frame.h>
#include <strahl/structures/wide_bvh/wide_rays.h>

namespace strahl {

inline constexpr float kWideMostT = 3e38f;  ///< stands for infinity, which products would make NaN

/// A ray in a tree's frame. What it hits is decided by the ray it was made of.
struct WideRay {
  float org[3], dir[3];
  float rcp[3], near[3], far[3];
  float org_slack, t_enter, t_enter_sure, t_blur2;  ///< as in WideRays
  std::uint32_t signs;
  double per_t, start, t_blur;

  /// @param widening what boxes must be widened by (RayFrame), in scene units
  WideRay(const Ray& ray, double widening, const WideFrame& frame);

  /// Writes it to ray `i` of a block, but for the bounds.
  void put(WideRays& rays, std::uint32_t i) const;

  /// Frame parameters that no hit with canonical t at or before `t` passes, and that every hit
  /// below has t before.
  float upper(double t) const;
  float lower(double t) const;
};

/// Floats a little above and below others that are not negative.
inline float float_a_little_above(float t) { return t * (1 + 0x1p-22f) + 1e-37f; }
inline float float_a_little_below(float t) { return t * (1 - 0x1p-22f) - 1e-37f; }

}  // namespace strahl
