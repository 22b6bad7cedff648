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

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include <strahl/math/ray.h>
#include <strahl/structures/wide_bvh/wide_frame.h>

namespace strahl {

/// A ray in a tree's frame. What it hits is decided by the ray it was made of.
inline constexpr float kWideMostT = 3e38f;  ///< stands for infinity, which products would make NaN

struct WideRay {
  float org[3], dir[3];
  float rcp[3], near[3], far[3];
  float org_slack;      ///< distance to be added to |a - org| for the origin's own error
  float t_enter;        ///< at most the frame's t of any wanted hit
  float t_enter_sure;   ///< hits behind it are behind t_min
  float t_blur2;        ///< twice t_blur, rounded up
  std::uint32_t signs;  ///< bit a: dir[a] < 0
  double per_t, start, t_blur;

  WideRay() = default;
  /// @param widening what boxes must be widened by (RayFrame), in scene units
  WideRay(const Ray& ray, double widening, const WideFrame& frame);

  /// Makes it from a unit ray of floats that starts near a scene in its own coordinates, in floats,
  /// False for all others, also for invalid ones.
  bool set_floats(const Vec3f& o, const Vec3f& d, float first, float last, const WideFrame& frame);

  /// Frame parameters that no hit with canonical t at or before `t` passes, and that every hit
  /// below has t before.
  float upper(double t) const;
  float lower(double t) const;
};

/// Floats a little above and below others that are not negative.
inline float float_a_little_above(float t) { return t * (1 + 0x1p-22f) + 1e-37f; }
inline float float_a_little_below(float t) { return t * (1 - 0x1p-22f) - 1e-37f; }

inline bool WideRay::set_floats(const Vec3f& o, const Vec3f& d, float first, float last,
                                const WideFrame& frame) {
  const float reach = static_cast<float>(frame.reach), squared = dot(d, d);
  const bool is_unit = squared >= 0.2501f && squared <= 1.0001f;
  const bool is_near = dot(o, o) <= 256.0f * reach * reach;
  if (!(is_unit & is_near & (first >= 0.0f) & (first <= kWideMostT) & (last >= 0.0f))) return false;
  // As in the general case, but c = -o r has two roundings more.
  const float farthest = std::max({std::abs(o.x), std::abs(o.y), std::abs(o.z)});
  const float spread = 0x1p-24f * (3.1f * reach + 4.1f * farthest);
  signs = 0;
  for (int a = 0; a < 3; ++a) {
    const float along = d[a] + 0.0f;  // no -0
    const float r = 1.0f / std::copysign(std::max(std::abs(along), 0x1p-60f), along);
    const float c = -o[a] * r, pad = spread * std::abs(r);
    org[a] = o[a], dir[a] = d[a], rcp[a] = r, near[a] = c - pad, far[a] = c + pad;
    signs |= std::bit_cast<std::uint32_t>(along) >> 31 << a;
  }
  org_slack = t_blur2 = 0.0f;
  t_enter = std::max(float_a_little_below(first), 0.0f);
  t_enter_sure = first > 0.0f ? float_a_little_above(first) : 0.0f;
  per_t = 1.0, start = t_blur = 0.0;
  return true;
}

}  // namespace strahl
