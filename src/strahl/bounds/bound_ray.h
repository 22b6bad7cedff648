// bounds/bound_ray.h - what the tests of bounding volumes need once per ray.
//
// Thread safety: values.
#pragma once

#include <algorithm>

#include <strahl/bounds/bound_margin.h>
#include <strahl/math/ray.h>

namespace strahl {

/// A prepared ray with the slack that its rounding asks for; see bound_margin.h.
struct BoundRay {
  Vec3d org, dir;
  Vec3d unit_dir;         ///< dir * inv_length
  double length;          ///< |dir|
  double inv_length;      ///< 1 / |dir|
  double inv_squared;     ///< 1 / dir.dir
  double slack;           ///< s per unit of |n|_1
  double distance_slack;  ///< no point of the ray is off by more: 2 * slack > sqrt(3) * slack

  BoundRay() = default;
  /// @param world encloses all that any of the volumes encloses
  BoundRay(const PreparedRay& ray, const Aabb& world) : org(ray.org), dir(ray.dir) {
    const double squared = dot(dir, dir);
    inv_squared = 1.0 / squared, length = std::sqrt(squared), inv_length = 1.0 / length;
    unit_dir = dir * inv_length;
    const double widening =
        std::max(norm_max(ray.near_org - ray.org), norm_max(ray.far_org - ray.org));
    const double reach =
        std::max({norm_max(org), norm_max(world.lo), norm_max(world.hi)}) + widening;
    slack = kBoundSlack * reach + widening;
    distance_slack = 2.0 * slack;
  }
};

/// A ray's line along a normal n: a + t b, with the sign of b and slack s applied.
struct SlabRay {
  double low_org, high_org;  ///< a + s, a - s: subtracted from lower and from upper planes
  double inv;                ///< 1 / b; +inf where b is 0 or -0
  bool negative;             ///< b < 0

  SlabRay() = default;
  SlabRay(double a, double b, double s)
      : low_org(a + s), high_org(a - s), inv(b == 0.0 ? Aabb::kInf : 1.0 / b), negative(b < 0.0) {}
  /// @param norm at least |n|_1
  SlabRay(const BoundRay& ray, const Vec3d& n, double norm)
      : SlabRay(dot(n, ray.org), dot(n, ray.dir), norm * ray.slack) {}
};

/// The part of `in` in which the ray may be where lo <= n.x <= hi. NaN cuts nothing.
inline Interval clip_to_slab(const SlabRay& ray, double lo, double hi, Interval in) {
  const double at_lo = (lo - ray.low_org) * ray.inv, at_hi = (hi - ray.high_org) * ray.inv;
  const double first = ray.negative ? at_hi : at_lo;
  const double last = (ray.negative ? at_lo : at_hi) * (1.0 + 2 * kPlaneMargin);
  in.t_enter = first > in.t_enter ? first : in.t_enter;
  in.t_exit = last < in.t_exit ? last : in.t_exit;
  return in;
}

/// The part of `in` in which the ray may be where n.x <= hi. NaN cuts nothing.
inline Interval clip_to_half_space(const SlabRay& ray, double hi, Interval in) {
  const double at = (hi - ray.high_org) * ray.inv;
  if (ray.negative) {
    in.t_enter = at > in.t_enter ? at : in.t_enter;
  } else {
    const double last = at * (1.0 + 2 * kPlaneMargin);
    in.t_exit = last < in.t_exit ? last : in.t_exit;
  }
  return in;
}

}  // namespace strahl
