// geometry/polygon.h - cuts a polygon in space into triangles over its own corners.
//
// Method:     the polygon is projected along the largest component of its Newell normal. Convex
//             ones fan out from corner 0; others are ear-clipped. Every decision is the sign of an
//             exact orientation, so the result is a pure function of the bits of the corners.
// Invariants: n - 2 triangles for n corners, always, in the polygon's orientation; no new vertices.
// Thread safety: pure function of its arguments.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <strahl/math/vec3.h>

namespace strahl {

/// Appends the triangles of one polygon, as indices into `corners`.
/// @param corners   n corners in order, first not repeated; n < 2^32
/// @param triangles receives n - 2 triples for n >= 3, else nothing. Convex: (0,1,2), (0,2,3), ...
/// Simple polygons, also with holes joined by a bridge edge, are covered exactly once (in the
/// projection). Polygons that cross themselves or have no area get n - 2 triangles of some kind;
/// those with corners that are not finite fan out.
/// Complexity: O(n) for convex polygons. Others: O(n log n) where few corners lie near each ear, as
/// in outlines met in practice; at worst O(n^2).
void triangulate_polygon(std::span<const Vec3d> corners,
                         std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace strahl
