// geometry/curved.h - what spheres and cones share: roots, and the rule that ties them to boxes.
//
// Rule: a hit exists only if the ray's line passes the primitive's own box by the canonical double
//   slab test, planes at (p - org) * (1 / dir), and its t is clamped into that slab interval. As
//   rounding is monotone, the same test of any enclosing box then encloses t, so no conservative
//   filter can disagree with the formula. Two roots that clamp to the same t are a tangent: none.
//   A caller does: box = bounds(x); hits = tie_to_box(intersect(x, org, dir), org, dir, box).
// Far origins: org + t*dir is evaluated relative to the primitive with exact differences and
//   products ([Dekker1971] two-sum and split product, no FMA), so only the rounding of t remains.
// Range: coordinates 0 or 2^-240..2^240 (see math/margin.h); nothing then overflows, and what
//   underflows is far below the rounding of what it is added to.
// Thread safety: pure functions. Needs round-to-nearest (see base/fp_env.h).
#pragma once

#include <array>

#include <strahl/math/ray.h>

namespace strahl {

/// One root: parameter and whether the ray enters the solid there (outward normal against dir).
struct CurvedHit {
  double t;
  bool is_front;
};

/// At most two roots in ascending t.
struct CurvedHits {
  std::array<CurvedHit, 2> hit{};
  int count = 0;
};

/// The canonical slab interval of a line with box, without margins; empty (t_enter > t_exit) on a
/// miss. NaN planes (dir 0, org on the plane) cut nothing; a line parallel to and outside of a
/// slab misses.
Interval canonical_slab(const Vec3d& org, const Vec3d& dir, const Aabb& box);

/// Applies the rule above: drops hits when the line misses the box, clamps t, drops equal pairs,
/// non-finite t, and turns -0 into +0. Idempotent.
CurvedHits tie_to_box(const CurvedHits& hits, const Vec3d& org, const Vec3d& dir, const Aabb& box);

/// The point of a line at parameter t + dt (unevaluated), as its offset high + low from a reference
/// point. Error below 2^-100 of the distances from the ray's origin to both, low below ulp(high).
struct LinePoint {
  double t = 0.0, dt = 0.0;
  Vec3d high, low;
};

/// org + t*dir - reference.
LinePoint point_at(const Vec3d& org, const Vec3d& dir, double t, const Vec3d& reference);

/// The point of the line nearest reference + shift, as its offset from reference. The second of its
/// two steps leaves it within a few ulps of |offset - shift| of the foot of the perpendicular, for
/// origins up to 2^50 times as far away.
LinePoint nearest_point(const Vec3d& org, const Vec3d& dir, const Vec3d& reference,
                        const Vec3d& shift);

/// The smallest interval of doubles that holds center -+ half_extent, per axis.
Aabb box_around(const Vec3d& center, const Vec3d& half_extent);

}  // namespace strahl
