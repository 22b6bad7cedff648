// structures/wide_bvh/wide_filter.h - what the float test of a block of triangles may be trusted
// with.
//
// The kernel evaluates Moeller and Trumbore's products [Moeller1997] in floats for each lane:
//   s = o - a, e1 = b - a, e2 = c - a, h = d x e2, q = s x e1,
//   det = e1 . h, U = s . h, V = d . q, T = e2 . q, made positive by the sign of det;
//   the line crosses where U, V, W = det - U - V >= 0, at t = T / det.
// It must never refuse a lane that the exact test (geometry/triangle.h) accepts, and may call a
// lane certain only if the exact test accepts it and its canonical t lies where the kernel says.
//
// Setting: u = 2^-24; L >= |e1|, |e2| of all lanes, S = |s| (2-norms), |d| <= 1.0001. Each product
// of three factors is one of six monomials of a determinant, whose magnitudes sum to at most 3! /
// 3^1.5 = 1.1547 times the product of the rows' norms [CarlenLiebLoss2006]. Roundings per monomial,
// without fused operations (which only have fewer): direction 1, edge 1, edge or s 1, product 1,
// difference 1, product 1, two sums 2: eight for U, V and det; T has no direction, but s and both
// edges: eight. With eight factors (1 + e), |e| <= u:
//   |dU|, |dV| <= 9.24 u |d| L S,  |ddet| <= 9.24 u |d| L^2,  |dT| <= 9.24 u L^2 S.
// The origin's float is off by a vector of norm x (0 for float rays; see wide_ray.h): x |d| L more
// in U and V, x L^2 in T.
//
// Crossing. Let D = |det as computed|. If its sign is right, a true hit has U >= 0, so its computed
// value is >= -dU; if it is wrong, the true |det| <= ddet, so 0 <= U <= ddet and the computed value
// is
// >= -(dU + ddet). The same for V; W adds both, and 5 u |d| L^2 for its own two roundings. With
//   E = u |d| (18.5 L S + 23.5 L^2) + 2 x |d| L
// a lane with a value below -E is certainly missed, and one with U, V, W > E is certainly crossed:
// then D > 3 E, so its sign is certain, too, and no edge value is 0 in exact arithmetic.
//
// Parameter. T/D - t = (dT + t ddet) / D, and |t d| <= S + L at a point of the triangle:
//   |T - t D| <= u L^2 (9.24 S + 9.24 (S + L)) + x L^2 + 6 u (S + L) L^2, the last for the
//   roundings
// of comparisons, quotient and interval; canonical t is within 2^-40 of t, which 6 u covers, too.
// That is below 1.4 L E / |d|. A wrong sign of det implies |T| <= t ddet + dT, the same bound.
//
// Corners rounded into the frame, or to 16 bits, are off by up to y each: e1 and e2 by 2 y, s by y.
// U = d . (e2 x s) moves by that of e2 times |s x d| = |d| R, R the distance of the line from a,
// and by y |d| (L + 2 y). A line that crosses the true or the stored triangle has R <= its L, so S
// does not matter:
//   U and V move by at most y |d| (3 L + 2 y), W, whose edge is up to 2 L long, by y |d| (6 L + 2
//   y), det by y |d| (4 L + 4 y).
// A true hit is stored with values above -y |d| (10 L + 6 y), the worst case W <= det where the
// sign of det is lost; so E gains y |d| 10 (L + 2 y), with L + 2 y for L everywhere. A lane whose
// computed values are above E crosses the stored triangle with values above that gain, so it
// crosses the true one, too.
// T - t det = (a - p) . n at the true point p moves by y (5 L^2 + 8 y L), whatever det is; it is in
// 1.4 L E / |d|.
// The constant -1e-30 covers what underflows at the magnitudes of a frame (at most 2^-126 2^22 per
// operation, also with subnormals flushed) and keeps -E negative, so that 0 >= 0 is uncertain.
#pragma once

#include <span>

#include <strahl/geometry/mesh.h>
#include <strahl/structures/wide_bvh/wide_tree.h>

namespace strahl {

/// 2 x |d| L as a multiple of the first term of E: x * kOriginWeight is what S must be raised by.
inline constexpr double kOriginWeight = 0.109 * 0x1p24;

/// Corners of a lane as stored.
struct LaneCorners {
  Vec3f a, b, c;
  double error = 0.0;  ///< at most this far from the true corners
};

/// Whether all coordinates are values of floats.
inline bool has_float_corners(const TriangleVertices& t) {
  const auto is_float = [](const Vec3d& v) { return Vec3d(Vec3f(v)) == v; };
  return is_float(t.a) && is_float(t.b) && is_float(t.c);
}

/// Corners in the frame, rounded to nearest.
LaneCorners lane_corners(const TriangleVertices& triangle, const WideFrame& frame);

/// The bounds of a block.
/// @param longest edge from a corner a, squared
/// @param error of all corners
LeafBound leaf_bound(double longest, double error);

/// The bounds of a block of these triangles. Infinite corners make every lane uncertain.
LeafBound leaf_bound(std::span<const LaneCorners> lanes);

}  // namespace strahl
