// bounds/plane.h - slabs and half-spaces of any orientation, as volumes store them.
//
// Normals are floats, taken as they are: a rounded unit vector is a normal like any other, and
// extents are computed for it. |n|_1 < kNorm.
// Thread safety: values.
#pragma once

#include <strahl/bounds/bound_ray.h>
#include <strahl/bounds/enclosed_set.h>
#include <strahl/math/float_round.h>

namespace strahl {

/// More than sqrt(3) (1 + 2^-22), the largest sum of magnitudes of a unit vector rounded to float.
inline constexpr double kNorm = 1.75;

/// A unit vector as stored.
inline Vec3f rounded_normal(const Vec3d& n) {
  return {float_nearest(n.x), float_nearest(n.y), float_nearest(n.z)};
}

/// lo <= n.x <= hi. 20 bytes.
struct Slab {
  Vec3f n;
  float lo = 1.0f, hi = -1.0f;

  /// The slab of a set across a unit vector.
  static Slab around(const EnclosedSet& set, const Vec3d& unit) {
    Slab s;
    s.n = rounded_normal(unit);
    const auto [lo, hi] = set.extent(Vec3d(s.n));
    s.lo = float_below(lo), s.hi = float_above(hi);
    return s;
  }
  Interval clip(const BoundRay& ray, Interval in) const {
    return clip_to_slab(SlabRay(ray, Vec3d(n), kNorm), lo, hi, in);
  }
  bool contains(const Vec3d& p) const {
    const double at = dot(Vec3d(n), p);
    return lo <= at && at <= hi;
  }
  double width() const { return double{hi} - double{lo}; }
};

/// n.x <= offset. 16 bytes.
struct FacePlane {
  Vec3f n;
  float offset = 0.0f;

  static FacePlane around(const EnclosedSet& set, const Vec3d& unit) {
    FacePlane f;
    f.n = rounded_normal(unit);
    f.offset = float_above(set.support(Vec3d(f.n)));
    return f;
  }
  Interval clip(const BoundRay& ray, Interval in) const {
    return clip_to_half_space(SlabRay(ray, Vec3d(n), kNorm), offset, in);
  }
  bool contains(const Vec3d& p) const { return dot(Vec3d(n), p) <= offset; }
};

}  // namespace strahl
