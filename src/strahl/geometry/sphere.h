// geometry/sphere.h - spheres: bounds, clip to a box, both roots of a ray.
//
// Formula (canonical, docs/semantics.md): measured from the point of the ray nearest the centre, so
//   that far origins lose nothing. Hits need the primitive's own box: see geometry/curved.h.
#pragma once

#include <strahl/geometry/curved.h>

namespace strahl {

/// A sphere; radius >= 0 (0 is never hit). Invalid (not finite, negative) spheres are never hit.
struct Sphere {
  Vec3d center;
  double radius = 0.0;
};

/// Smallest box, rounded outward; empty where the sphere can never be hit.
Aabb bounds(const Sphere& sphere);

/// Conservative bounds of the part of the sphere inside box; empty only if that part is.
Aabb clip(const Sphere& sphere, const Aabb& box);

/// The roots of the ray's whole line, t ascending, each with its unit outward normal's sign
/// against dir. A tangent ray has none.
CurvedHits intersect(const Sphere& sphere, const Vec3d& org, const Vec3d& dir);

/// Unit outward normal at org + t*dir.
Vec3d normal_at(const Sphere& sphere, const Vec3d& org, const Vec3d& dir, double t);

}  // namespace strahl
