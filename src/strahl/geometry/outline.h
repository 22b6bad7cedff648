// geometry/outline.h - a convex set around a thing, closer than its box: what beams are tested
// against.
//
// Contract: whenever a ray hits the thing, the ray passes through its outline, up to the rounding
//   that the ray's own widening (math/ray.h) and 2^-44 of the distances from its origin cover.
//   Triangles: exactly, the hull of the corners.
//   Spheres: a hit needs r^2 - p.p > 0 for a point p of the line known to 2^-100
//   (geometry/sphere.h),
//     so the line passes the sphere, and t is within a few roundings of the root.
//   Cones: a hit is a point of the line between the planes of the two rims whose residual q, the
//     quadratic form of the double cone, is only the rounding of its discriminant carried over.
//     In units of the cone's size that rounding is below 2^-38. For a root -C / (B + R), q(u) is
//     err * u^2 / C, |u| <= 8, and a point outside by s has q >= s^2, so s < 2^-7 or so where the
//     generators are no flatter than 60 degrees against the axis; a root (R - B) / A, R being at
//     least 2^-26 of what it is the root of, is never between the rims unless A >= 2^-30, where it
//     is as good. Cylinders divide the common factor |D|^2 out, so only roundings remain. Flatter
//     cones get the ball outside of which intersect() finds nothing.
//   Under an instance, curved things are hit only within the image of their own box.
// Thread safety: pure functions.
#pragma once

#include <array>
#include <span>

#include <strahl/math/affine.h>

namespace strahl {

struct Cone;
struct Sphere;
struct TriangleVertices;

/// A closed ball; radius 0 is a point.
struct Ball {
  Vec3d center;
  double radius = 0.0;
};

/// The hull of at most eight balls; none: only the box is known. Three stand for a triangle whose
/// front is seen along -(b - a) x (c - a), as everywhere.
struct Outline {
  std::array<Ball, 8> ball;
  std::size_t count = 0;
  /// What is outlined, if it is a cone; its source's own.
  const Cone* cone = nullptr;

  std::span<const Ball> balls() const { return {ball.data(), count}; }
  bool is_triangle() const { return count == 3; }
  bool is_sphere() const { return count == 1 && cone == nullptr; }
};

/// @param map world from object; a mirrored triangle keeps its front
Outline outline_of(const TriangleVertices& tri, const Affine& map);
Outline outline_of(const Sphere& sphere);
Outline outline_of(const Cone& cone);
/// The image of a box.
Outline outline_of(const Aabb& box, const Affine& map);

}  // namespace strahl
