// bounds/prism_volume.h - the right prism over a convex polygon.
//
// Papers:     [Barequet1996]. The axis is chosen as the cylinder's; the base is the outline across
//             it, reduced to kMostSides edges by leaving out the edge whose neighbours, extended,
//             add the least area.
// Layout:     one slab for the ends, up to 8 planes for the sides: 152 bytes. Corners sharper than
//             about 10 degrees are cut off square, so that rounded normals always close the base.
//             Offsets are computed for the rounded normals from all points.
// Margins:    bound_margin.h.
// Measure:    of the polytope. merge(): around the corners of both.
// Thread safety: values.
#pragma once

#include <array>

#include <strahl/bounds/bounding_volume.h>
#include <strahl/bounds/convex_hull.h>
#include <strahl/bounds/plane.h>
#include <strahl/bounds/polytope.h>
#include <strahl/bounds/sphere_volume.h>

namespace strahl {

class PrismVolume {
 public:
  static constexpr BoundingVolumeKind kKind = BoundingVolumeKind::prism;
  static constexpr std::size_t kMostSides = 8;
  using RayData = PlainRay;

  PrismVolume() = default;
  static PrismVolume enclose(const EnclosedSet& set, FitEffort effort = FitEffort::thorough);
  static PrismVolume merge(const PrismVolume& a, const PrismVolume& b) {
    return merge_by_corners(a, b);
  }

  Interval clip(const BoundRay& ray, Interval in) const {
    in = ends_.clip(ray, in);
    for (std::uint32_t i = 0; i < sides_; ++i) in = side_[i].clip(ray, in);
    return in;
  }
  double half_area() const { return measure().half_area; }
  double volume() const { return measure().volume; }
  bool contains(const Vec3d& p) const;
  std::size_t bytes() const { return sizeof(*this); }
  /// Around the corners, a little wider.
  Aabb box() const;
  void add_corners_to(EnclosedSet& set) const;
  void add_sides_to(SideList& sides) const;
  void add_planes_to(Polytope& body) const;

 private:
  bool is_empty() const { return !(ends_.lo <= ends_.hi); }
  Polytope::Measure measure() const;
  Slab ends_;
  std::uint32_t sides_ = 0;
  std::array<FacePlane, kMostSides> side_;
};
static_assert(sizeof(PrismVolume) == 152 && PolyhedralVolume<PrismVolume>);

/// Outward unit normals of a convex polygon's edges, counter-clockwise, reduced to at most
/// `most` >= 4 by the rule above, sharp corners cut off. Two or three points on a line, or one, get
/// those of a rectangle.
std::vector<Vec2d> reduced_normals(const std::vector<Vec2d>& polygon, std::size_t most);

}  // namespace strahl
