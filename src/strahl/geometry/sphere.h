// geometry/sphere.h - spheres: bounds, clip to a box, both roots of a ray.
//
// Formula (canonical, docs/semantics.md): with T the parameter of the point of the ray nearest the
//   centre and p its offset from the centre (geometry/curved.h: both to twice double precision),
//   t = T -+ sqrt(r^2 - p.p) / |dir|. r^2 - p.p is a double-double sum rounded once; a value
//   not above 0 is a miss or a tangent: no hit. Measured (sphere_test.cpp) for origins 1e-3..1e9
//   radii away: t is within 1e-15 * max(|t|, r / |dir|) of the truth, hit or miss is right, unless
//   r^2 - p.p is within 1e-9 r^2 of 0.
//   Hits need the primitive's own box: see geometry/curved.h.
// Thread safety: pure functions.
#pragma once

#include <strahl/geometry/curved.h>

namespace strahl {

/// A sphere; radius >= 0 (0 is never hit). Invalid spheres are never hit: a negative radius, a
/// centre or radius that is not finite or of magnitude outside 0, 2^-240..2^240.
struct Sphere {
  Vec3d center;
  double radius = 0.0;
};

/// Smallest box of doubles, rounded outward; empty where the sphere can never be hit.
Aabb bounds(const Sphere& sphere);

/// Conservative bounds of the part of the sphere inside box; empty only if that part is.
/// No tighter than bounds() cut by box: t places a hit only to within the rounding of t, which is
/// more than any fixed margin for a far origin, and it is bounds() that the hit is tied to.
Aabb clip(const Sphere& sphere, const Aabb& box);

/// The roots of the ray's whole line, t ascending, each with its unit outward normal's sign
/// against dir. A tangent ray has none. Not yet tied to the box: see tie_to_box().
CurvedHits intersect(const Sphere& sphere, const Vec3d& org, const Vec3d& dir);

/// Unit outward normal at org + t*dir; against dir where that point rounds to the centre itself.
Vec3d normal_at(const Sphere& sphere, const Vec3d& org, const Vec3d& dir, double t);

}  // namespace strahl
