// bounds/enclosed_set.h - what a bounding volume has to enclose: points and balls, from primitives.
//
// Layout:     the convex hull of points and balls is what convex volumes enclose. Triangles, layers
//             and capsules say besides where surfaces are, for volumes with a hole.
// Spheres     become balls, their surface a layer of no thickness.
// Cones       become the two circumscribed 24-gons of their rims, 0.9 % wider than these. Their
//             canonical hits (geometry/cone.h) lie off the solid by rounding: measured at most
//             2^-34 of its size, and 2^-42 where the height is 2^-10 of the difference of the
//             radii, for adversarial rays. Both radii are raised by 2^-20 of the size, which moves
//             the surface out by 2^-30 of it at that slope; flatter cones are enclosed as the own
//             box that every hit is tied to.
// Invariants: everything is finite; what can never be hit is left out.
// Thread safety: const access from any number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <strahl/geometry/outline.h>
#include <strahl/geometry/scene.h>

namespace strahl {

/// Points between two concentric spheres.
struct Layer {
  Vec3d center;
  double inner = 0.0, outer = 0.0;
};

/// Points within `radius` of a segment.
struct Capsule {
  Vec3d a, b;
  double radius = 0.0;
};

class EnclosedSet {
 public:
  /// A point that is not finite is ignored, and so is a triangle with such a vertex.
  void add(const Vec3d& point);
  void add(const TriangleVertices& tri);
  void add(const Sphere& sphere);
  void add(const Cone& cone);
  /// The eight corners and all between. Nothing for an empty box.
  void add(const Aabb& box);
  /// Solid, as a merged volume is.
  void add(const Ball& ball);
  void add(const Layer& layer);
  /// Thing i of a source: its triangle, sphere or cone where it is one, else the box that its hits
  /// are tied to. Nothing for what can never be hit.
  void add(const PrimitiveSource& source, std::uint32_t i);
  /// A corner of something solid: part of the hull without being a surface of its own. One that is
  /// not finite makes the set unbounded.
  void add_corner(const Vec3d& point);
  /// The same of a body with a hole, whose surface is added apart.
  void add_outline(const Vec3d& point);
  void add_surface(const Layer& layer) { layers_.push_back(layer); }
  void append(const EnclosedSet& other);

  bool is_empty() const { return points_.empty() && balls_.empty() && !is_unbounded_; }
  /// Holds something without end, as volumes beyond float's range are: only everything encloses it.
  bool is_unbounded() const { return is_unbounded_; }
  std::span<const Vec3d> points() const { return points_; }
  std::span<const Ball> balls() const { return balls_; }
  /// Of the primitives' own boxes, exact.
  const Aabb& box() const { return box_; }

  /// Not above and not below n.x for any x enclosed; see bound_margin.h.
  std::pair<double, double> extent(const Vec3d& n) const;
  double support(const Vec3d& n) const { return extent(n).second; }
  /// Not below |x - center| for any x enclosed.
  double farthest_from(const Vec3d& center) const;
  /// Not above |x - center| for any x on a surface; 0 once there is a corner of something solid.
  double nearest_to(const Vec3d& center) const;

 private:
  void add_ball(const Ball& ball, const Aabb& own_box);
  void add_rim(const Vec3d& center, double radius, const Vec3d& axis);

  std::vector<Vec3d> points_;
  std::vector<Ball> balls_;
  std::vector<std::uint32_t> triangles_;  ///< index of the first of three consecutive points
  std::vector<Layer> layers_;
  std::vector<Capsule> capsules_;
  Aabb box_;
  bool is_unbounded_ = false, is_solid_ = false;
};

/// Distance of a point from a closed triangle, within rounding.
double distance_to(const TriangleVertices& tri, const Vec3d& p);

}  // namespace strahl
