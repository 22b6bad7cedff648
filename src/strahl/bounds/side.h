// bounds/side.h - the boundary of a volume as smooth sides, for measuring what lies inside.
//
// A volume is where the depth of all of its sides is at least 0: up to rounding, what contains()
// says. Planes leave half-spaces, balls and tubes (endless round cylinders) their inside, holes
// what is outside a ball, cones what lies within an angle of an axis of at most 90 degrees.
// Invariants: depth() changes by no more than the distance that its point moves, so a ball around a
//   point is on one side for sure where the depth of the point exceeds its radius.
// Thread safety: values.
#pragma once

#include <cstdint>
#include <vector>

#include <strahl/math/aabb.h>

namespace strahl {

struct VolumeSide {
  enum class Shape : std::uint8_t { plane, ball, hole, tube, cone };

  Shape shape = Shape::plane;
  Vec3d center;       ///< a point of the axis; of a cone its apex; unused by planes
  Vec3d n;            ///< unit: outward normal, or axis
  double size = 0.0;  ///< offset, radius, or cosine
  double fine = 0.0;  ///< width of what is taken to be cut along a straight line; 0 for planes

  /// n.x <= offset; n need not be unit. Nothing is inside for an offset of -infinity.
  static VolumeSide plane(const Vec3d& n, double offset);
  static VolumeSide ball(const Vec3d& center, double radius);
  static VolumeSide hole(const Vec3d& center, double radius);
  static VolumeSide tube(const Vec3d& center, const Vec3d& axis, double radius);
  /// Within acos(cosine) of a unit axis, as seen from the apex; cosine >= 0.
  /// @param reach how far from the apex it matters
  static VolumeSide cone(const Vec3d& apex, const Vec3d& axis, double cosine, double reach);

  /// Positive inside, negative outside.
  double depth(const Vec3d& p) const;
  /// Whether a piece between points inside is inside.
  bool is_convex() const { return shape != Shape::hole; }
};

/// The sides of a volume, in no order. Those without end are left out.
class SideList {
 public:
  explicit SideList(std::vector<VolumeSide>& out) : out_(out) {}
  void add(const VolumeSide& side) {
    if (side.size < Aabb::kInf) out_.push_back(side);
  }
  void add(const Aabb& box);
  /// lo <= n.x <= hi
  void add_slab(const Vec3d& n, double lo, double hi);

 private:
  std::vector<VolumeSide>& out_;
};

}  // namespace strahl
