// bounds/convex_hull.h - convex hulls of points, in space by qhull, in a plane by a monotone chain.
//
// Papers:     quickhull [Barber1996]; monotone chain [Andrew1979].
// Accuracy:   qhull works in double with merged facets; a point that sticks out by less than about
//             2^-48 of the size may be left out. Volumes take their extents from all points.
// Thread safety: safe from any number of threads (the reentrant qhull).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <strahl/math/vec3.h>

namespace strahl {

struct ConvexHull {
  std::vector<std::uint32_t> vertices;                  ///< ascending indices of extreme points
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of the surface, outward
};

/// Empty for fewer than four points and for points that lie in a plane to within rounding.
std::optional<ConvexHull> convex_hull(std::span<const Vec3d> points);

struct Vec2d {
  double x, y;
};

/// Corners of the convex hull counter-clockwise, without collinear ones; one or two for points that
/// coincide or lie on a line.
std::vector<Vec2d> convex_polygon(std::vector<Vec2d> points);

}  // namespace strahl
