// bounds/obb_volume.h - the oriented box: three slabs across axes that follow the geometry.
//
// Papers:     [Gottschalk1996]; the fit is obb_fit.h.
// Layout:     three slabs, 60 bytes. The normals are unit and orthogonal to float precision.
// Margins:    bound_margin.h; extents are computed for the rounded normals, so nothing depends on
//             their being orthogonal but the measures, which are off by a relative 2^-21 at most.
// Differs:    boxes are chosen by area, the chance of being hit, where the papers want volume.
// merge():    the box around the corners of both; also along the axes of either.
// Thread safety: values.
#pragma once

#include <array>

#include <strahl/bounds/bounding_volume.h>
#include <strahl/bounds/obb_fit.h>
#include <strahl/bounds/plane.h>
#include <strahl/bounds/sphere_volume.h>

namespace strahl {

class ObbVolume {
 public:
  static constexpr BoundingVolumeKind kKind = BoundingVolumeKind::obb;
  using RayData = PlainRay;

  ObbVolume() = default;
  static ObbVolume enclose(const EnclosedSet& set, FitEffort effort = FitEffort::thorough,
                           ObbGoal goal = ObbGoal::area);
  /// By covariance alone.
  static ObbVolume enclose_by_covariance(const EnclosedSet& set);
  static ObbVolume around(const EnclosedSet& set, const ObbAxes& axes);
  static ObbVolume merge(const ObbVolume& a, const ObbVolume& b);

  Interval clip(const BoundRay& ray, Interval in) const {
    for (const Slab& s : slab_) in = s.clip(ray, in);
    return in;
  }
  double half_area() const;
  double volume() const;
  bool contains(const Vec3d& p) const;
  std::size_t bytes() const { return sizeof(*this); }
  Aabb box() const;
  void add_corners_to(EnclosedSet& set) const;
  void add_sides_to(SideList& sides) const;
  void add_planes_to(Polytope& body) const;

 private:
  bool is_empty() const { return !(slab_[0].lo <= slab_[0].hi); }
  ObbAxes axes() const;
  std::array<Slab, 3> slab_;
};
static_assert(sizeof(ObbVolume) == 60 && PolyhedralVolume<ObbVolume>);

}  // namespace strahl
