// bounds/bound_margin.h - the outward margins of bounding volumes, each with its proof.
//
// Setting: u = 2^-53, coordinates as in math/margin.h. A ray o + t*d is wanted at x = o + t*d when
//   x lies in what is enclosed. All of it lies in a box W ("world"), so with M the largest
//   magnitude of o and of W's corners, |x_i| <= M and |t d_i| <= 2 M per axis.
// Curved hits: t is canonical, not exact. A sphere's own formula (geometry/sphere.h) places x
//   within 2^-48 (|x - o| + r) < 2^-45 M of it. Cones are inflated when they are enclosed
//   (enclosed_set.cpp). Under instances x moves by up to w per axis, the widening of RayFrame.
// Slabs (obb, k-DOP, prism, hull): A = fl(n.o) and B = fl(n.d) have three roundings per term, so
//   |A + t B - n.x| <= gamma(3) |n|_1 (M + 2 M) < 2^-49 |n|_1 M. With lo <= n.x <= hi the
//   inequality lo - s <= A + t B <= hi + s holds for s = |n|_1 (kBoundSlack M + w), which is many
//   times that and covers the curved hits and the rounding of A +- s, too. A and B are then numbers
//   like any others: dividing leaves relative errors of 2^-51, which kPlaneMargin covers. A tiny B
//   needs no special case, as all uncertainty is in s; B = 0 divides to an infinity of the right
//   sign, or to NaN, which cuts nothing.
// Round volumes (sphere, cylinder, shell): see near_line.h.
// Building: fl(n.p) of a point is off by at most gamma(3) |n|_1 max|p|; supports are raised by
//   kSupportMargin |n|_1 max|p| > twice that, then rounded outward to float. So contains(), which
//   evaluates in double without a margin, is true of every enclosed point.
#pragma once

namespace strahl {

/// Of the largest coordinate, per unit of |n|_1.
inline constexpr double kBoundSlack = 0x1p-44;
/// Of the largest coordinate, per unit of |n|_1.
inline constexpr double kSupportMargin = 0x1p-50;
/// Distances computed by a few roundings are raised or lowered by this part of themselves.
inline constexpr double kDistanceMargin = 0x1p-49;
/// Corners of a volume are computed with its planes moved out by this part of its size.
inline constexpr double kCornerMargin = 0x1p-40;

}  // namespace strahl
