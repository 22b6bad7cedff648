// geometry/curved.h - what spheres and cones share: roots, and the rule that ties them to boxes.
//
// Rule: a hit exists only if the ray's line passes the primitive's own box by the canonical double
//   slab test, planes at (p - org) * (1 / dir), and its t is clamped into that slab interval. As
//   rounding is monotone, the same test of any enclosing box then encloses t, so no conservative
//   filter can disagree with the formula. Two roots that clamp to the same t are a tangent: none.
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
/// non-finite t, and turns -0 into +0.
CurvedHits tie_to_box(CurvedHits hits, const Vec3d& org, const Vec3d& dir, const Aabb& box);

}  // namespace strahl
