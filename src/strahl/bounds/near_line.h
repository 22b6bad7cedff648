// bounds/near_line.h - a ray seen from a centre: what sphere, cylinder and shell are tested with.
//
// Re-centring at the point nearest the centre keeps far origins harmless: with l = c - o,
//   t0 = fl(l.d / d.d), e = fl(l - t0 d), the point of the ray at arc length v = (t - t0) |d| is
//   c - e + v d/|d|. e is off by less than 6 u |l|_1 and d.e by 6 u |d| |l|_1; |l| <= 2 sqrt(3) M
//   + r. So |x - c| <= r implies |e|^2 + v^2 <= r^2 + 24 u |l| r, hence v^2 <= (r + S)^2 - |e|^2
//   for S = distance_slack + 2^-46 r, with 2 r S to spare for the roundings of that expression.
//   t0 + v / |d| rounds by u (|l| + r) / |d|, so both ends move out by S / |d|; likewise back.
// Thread safety: pure functions.
#pragma once

#include <cmath>

#include <strahl/bounds/bound_ray.h>

namespace strahl {

struct NearLine {
  double t;      ///< of the point of the ray nearest the centre
  Vec3d offset;  ///< that point, as seen from the centre
  double slack;  ///< S: every length below is off by less

  /// @param radius of a ball around the centre that holds all that is wanted
  NearLine(const BoundRay& ray, const Vec3d& center, double radius) {
    const Vec3d l = center - ray.org;
    t = dot(l, ray.dir) * ray.inv_squared;
    offset = t * ray.dir - l;
    slack = ray.distance_slack + 0x1p-46 * radius;
  }
  /// (r + S)^2 - |e|^2: its root and S are at least half the chord. Negative for a certain miss.
  double squared_half_chord(double radius) const {
    const double r = radius + slack;
    return r * r - dot(offset, offset);
  }
  /// The arc lengths `v` cut to parameters `in`, which lose S at both ends. NaN cuts nothing.
  Interval part_of(const BoundRay& ray, const Interval& in, Interval v) const {
    const double first = (in.t_enter - t) * ray.length - slack;
    const double last = (in.t_exit - t) * ray.length + slack;
    v.t_enter = first > v.t_enter ? first : v.t_enter;
    v.t_exit = last < v.t_exit ? last : v.t_exit;
    return v;
  }
  /// `in` cut to arc lengths [first, last] around the nearest point. NaN cuts nothing.
  Interval cut(const BoundRay& ray, double first, double last, Interval in) const {
    const double enter = t + (first - slack) * ray.inv_length;
    const double exit = t + (last + slack) * ray.inv_length;
    in.t_enter = enter > in.t_enter ? enter : in.t_enter;
    in.t_exit = exit < in.t_exit ? exit : in.t_exit;
    return in;
  }
};

inline constexpr Interval kNoInterval{Aabb::kInf, -Aabb::kInf};

}  // namespace strahl
