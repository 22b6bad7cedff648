// build/cut_piece.h - the surface of one primitive, cut to volumes of any kind and measured.
//
// Triangles: convex polygons. A plane cuts them exactly, up to rounding. At a curved side
//   (bounds/side.h) a polygon is halved until it reaches no more than 1/16 of the radius from its
//   middle, and then cut along a straight line. Chords lie inside of arcs: of the section of a ball
//   or a tube less is missed than 0.3 % of a circle of its radius, and as much of a hole is
//   counted.
// Spheres and cones: patches as in geometry/surface_piece.h, halved where the boundary of a volume
//   crosses them; those small against the volume become two triangles that together have the weight
//   of the patch's area, and are cut as such from then on.
// Accuracy: within 1 % of what a volume holds of the surface of much larger things; overlaps of
//   whole trees agree with random points within their noise (cut_piece_test, volume_overlap_test).
// Thread safety: values.
#pragma once

#include <vector>

#include <strahl/build/side_tree.h>
#include <strahl/geometry/surface_piece.h>

namespace strahl {

/// A volume somewhere in the world.
struct PlacedVolume {
  std::span<const VolumeSide> sides;
  double extent = 0.0;
  const Placement* placement = nullptr;  ///< null: in world space

  /// As VolumeSide::depth(), in lengths of the world. Under an instance raised by what the map may
  /// round, so that surface in the plane of a flat volume is inside, as it is without a map.
  double depth(const VolumeSide& side, const Vec3d& p) const;
  /// A length of object space, at its shortest in the world.
  double in_world(double length) const {
    return placement == nullptr ? length : length / placement->stretch;
  }
};

/// What is inside all volumes that it was cut to.
class CutPiece {
 public:
  explicit CutPiece(const TriangleVertices& t) : flat_{{{t.a, t.b, t.c}, 1.0}} {}
  /// The surface must outlive it.
  explicit CutPiece(const CurvedSurface& surface) : surface_(&surface), patches_{surface.whole()} {}

  void cut_to(const PlacedVolume& volume);
  bool is_empty() const { return flat_.empty() && patches_.empty(); }
  double area() const;

 private:
  /// A convex polygon that stands for `weight` times its area.
  struct Flat {
    std::vector<Vec3d> corners;
    double weight;
  };

  class Knife;
  void cut_patches(const PlacedVolume& volume);
  void flatten(const Patch& patch);

  const CurvedSurface* surface_ = nullptr;
  std::vector<Patch> patches_;  ///< inside as a whole
  std::vector<Flat> flat_;
};

}  // namespace strahl
