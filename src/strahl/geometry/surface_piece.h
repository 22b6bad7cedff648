// geometry/surface_piece.h - the surface of one primitive of a scene, cut to boxes and measured.
//
// Triangles: convex polygons, cut plane by plane; exact up to rounding.
// Spheres and cones: patches of two parameters, each inside a ball around its middle. A patch that
//   may cross a face of the box is halved until its ball is smaller than 1/8 of the box and of the
//   surface's width; then it counts by the share that two triangles have in the box, between its
//   corners, moved to where the patch is in the mean. Errors are below 0.3 % of the surface and 1 %
//   of what lies in a box much smaller than it (surface_piece_test.cpp).
// Areas of patches are exact; under an instance the area in object space times the stretch at the
//   middle, of parts of at most 1/16 of the whole.
// Boxes that a piece is cut to one after the other lie in each other.
// Thread safety: values.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

#include <strahl/geometry/scene.h>

namespace strahl {

/// Part of a triangle inside boxes: at most 3 + 6 corners.
class FlatPiece {
 public:
  explicit FlatPiece(const TriangleVertices& triangle);

  void cut_to(const Aabb& box);
  bool is_empty() const { return count_ < 3; }
  double area() const;

 private:
  void cut(int axis, double plane, double side);

  std::array<Vec3d, 10> corner_;
  std::size_t count_ = 3;
};

/// Ranges of the parameters: u is the colatitude of a sphere, the height in a cone over that of its
/// axis; v the angle around.
struct Patch {
  double u0, u1, v0, v1;
};

/// A valid sphere or cone in world space.
class CurvedSurface {
 public:
  CurvedSurface(const Sphere& sphere, const Affine& to_world);
  CurvedSurface(const Cone& cone, const Affine& to_world);

  Patch whole() const;
  std::array<Patch, 2> halves(const Patch& patch) const;
  Vec3d point(double u, double v) const;
  Vec3d middle(const Patch& patch) const {
    return point(0.5 * (patch.u0 + patch.u1), 0.5 * (patch.v0 + patch.v1));
  }
  /// Radius of a ball around the middle that holds the patch.
  double reach(const Patch& patch) const;
  double area(const Patch& patch) const;
  /// Two triangles between its corners, moved to where the patch is in the mean.
  std::array<TriangleVertices, 2> flattened(const Patch& patch) const;
  /// The part of its area inside the box, as if it was flat.
  double share_inside(const Patch& patch, const Aabb& box) const;
  /// Patches that the boundary of something of that extent crosses are halved down to this.
  double fine_reach(double extent) const;

 private:
  double radius_at(double u) const;
  double largest_radius(const Patch& patch) const;
  /// Lengths in object space along u and along v.
  std::array<double, 2> lengths(const Patch& patch) const;
  double object_area(const Patch& patch) const;
  double stretch_at(double u, double v) const;
  void finish();

  bool is_sphere_;
  Vec3d origin_;                ///< centre or base
  std::array<Vec3d, 3> axes_;   ///< unit; the third is the cone's
  double radius_, top_radius_;  ///< of a sphere the same
  double height_ = 0.0, slant_ = 0.0;
  Affine to_world_;
  bool is_placed_;  ///< under a map other than the identity
  double longest_stretch_ = 1.0, least_reach_ = 0.0;
  double width_ = 0.0;  ///< largest diameter
};

/// Part of a sphere or cone inside boxes. The surface must outlive it.
class CurvedPiece {
 public:
  explicit CurvedPiece(const CurvedSurface& surface)
      : surface_(&surface), patches_{surface.whole()}, area_(surface.area(surface.whole())) {}

  void cut_to(const Aabb& box);
  bool is_empty() const { return patches_.empty(); }
  double area() const { return area_; }

 private:
  const CurvedSurface* surface_;
  std::vector<Patch> patches_;  ///< all that reach into the box
  double area_;                 ///< of what they have in it
};

/// visit(surface) with a primitive that can be hit, in world space: its TriangleVertices or its
/// CurvedSurface.
template <class Visit>
auto visit_shape(const Scene& scene, std::uint32_t reference, Visit visit) {
  const Part& part = scene.part_of(reference);
  const Geometry& g = scene.geometries()[part.geometry];
  const std::uint32_t prim = reference - part.first_reference;
  const Affine map =
      scene.is_identity(part.instance) ? Affine{} : scene.instances()[part.instance].to_world;
  if (g.kind == PrimitiveKind::triangle) {
    const TriangleVertices t = g.mesh[prim];
    return visit(TriangleVertices{map.point(t.a), map.point(t.b), map.point(t.c)});
  }
  const CurvedSurface surface = g.kind == PrimitiveKind::sphere
                                    ? CurvedSurface(g.spheres[prim], map)
                                    : CurvedSurface(g.cones[prim], map);
  return visit(surface);
}

/// visit(piece) with all of it, as a FlatPiece or a CurvedPiece.
template <class Visit>
auto visit_surface(const Scene& scene, std::uint32_t reference, Visit visit) {
  return visit_shape(scene, reference, [&]<class Shape>(const Shape& shape) {
    if constexpr (std::is_same_v<Shape, TriangleVertices>)
      return visit(FlatPiece(shape));
    else
      return visit(CurvedPiece(shape));
  });
}

}  // namespace strahl
