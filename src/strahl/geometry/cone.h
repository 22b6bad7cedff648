// geometry/cone.h - open cylinders, cones and truncated cones: bounds, clip to a box, roots.
//
// Formula (canonical, docs/semantics.md): from the point P of the ray nearest the middle of
//   the axis, relative to base (geometry/curved.h), lengths and dir scaled by powers of two. With a
//   the unit axis, (c, s) the cosine and sine of the slope (apex_radius - base_radius over the
//   height), X' = X - (X.a) a, D = dir', e = c*base_radius + s*(P.a), g = s*(dir.a), the surface is
//     A u^2 + 2 B u + C = 0, A = c^2 D.D - g^2, B = c^2 P'.D - g e, C = c^2 P'.P' - e^2,
//     B^2 - A C = c^2 (|e D - g P'|^2 - c^2 |D x P'|^2), A, C and this evaluated as products of sum
//     and difference. A value not above 0 is a miss or a tangent: no hit. The root in front is
//     (-B - R) / A, R the square root; whichever of q / A, C / q does not cancel is used, so A may
//     be 0 (parallel to a generator line: the other root is infinite and drops out).
//   A root counts when its axial coordinate lies in [0, height], which also drops the mirror nappe.
//   D is (axis x (dir x axis)) / axis^2: exactly 0 for a ray along the axis, which has no root of a
//   cylinder. Measured (cone_test.cpp) for height / radius 0.01..100 and origins up to 1e9 sizes
//   away, with b = B^2 - A C in units of size^2 |dir|^2: t is within
//   2e-15 / sqrt(b) * max(|t|, size / |dir|) of the truth and the number of hits is right, unless
//   |b| < 1e-10 (tangents) or a root lies within 1e-8 heights of a rim. There are no end caps.
//   Hits need the primitive's own box: see geometry/curved.h.
// Thread safety: pure functions.
#pragma once

#include <strahl/geometry/curved.h>

namespace strahl {

/// Lateral surface between two circles around the axis base -> apex. Equal radii: a cylinder; one
/// radius 0: a full cone. Invalid cones are never hit: a negative radius, base == apex, both radii
/// 0, numbers that are not finite or of magnitude outside 0, 2^-240..2^240.
struct Cone {
  Vec3d base;
  double base_radius = 0.0;
  Vec3d apex;
  double apex_radius = 0.0;
};

/// Box of the lateral surface: exact up to outward rounding where the axis is parallel to a
/// coordinate axis, else within 2^-48 of the radii. Empty where it can never be hit.
Aabb bounds(const Cone& cone);

/// Conservative bounds of the part of the cone inside box; empty only if that part is.
/// No tighter than bounds() cut by box: t places a hit only to within the rounding of t, which is
/// more than any fixed margin for a far origin, and it is bounds() that the hit is tied to.
Aabb clip(const Cone& cone, const Aabb& box);

/// The roots of the ray's whole line on the lateral surface, t ascending. A tangent has none.
/// Not yet tied to the box: see tie_to_box().
CurvedHits intersect(const Cone& cone, const Vec3d& org, const Vec3d& dir);

/// Unit outward normal of the lateral surface at org + t*dir; against dir on the axis itself.
Vec3d normal_at(const Cone& cone, const Vec3d& org, const Vec3d& dir, double t);

}  // namespace strahl
