// geometry/cone.h - open cylinders, cones and truncated cones: bounds, clip to a box, roots.
//
// Formula (canonical, docs/semantics.md): measured from the point of the ray nearest the middle of
//   the axis. There are no end caps. Hits need the primitive's own box: see geometry/curved.h.
#pragma once

#include <strahl/geometry/curved.h>

namespace strahl {

/// Lateral surface between two circles around the axis base -> apex. Equal radii: a cylinder; one
/// radius 0: a full cone. Invalid (not finite, negative radius, base == apex, both radii 0) cones
/// are never hit.
struct Cone {
  Vec3d base;
  double base_radius = 0.0;
  Vec3d apex;
  double apex_radius = 0.0;
};

/// Box of the lateral surface, tight up to outward rounding; empty where it can never be hit.
Aabb bounds(const Cone& cone);

/// Conservative bounds of the part of the cone inside box; empty only if that part is.
Aabb clip(const Cone& cone, const Aabb& box);

/// The roots of the ray's whole line on the lateral surface, t ascending. A tangent has none.
CurvedHits intersect(const Cone& cone, const Vec3d& org, const Vec3d& dir);

/// Unit outward normal of the lateral surface at org + t*dir.
Vec3d normal_at(const Cone& cone, const Vec3d& org, const Vec3d& dir, double t);

}  // namespace strahl
