// bounds/hull_volume.h - the convex hull: met by the fewest rays, dearest to test.
//
// Papers:     quickhull [Barber1996]; the test is that of [CyrusBeck1978], plane by plane.
// Layout:     a box of floats and up to kMostPlanes planes: 48 bytes and 16 per plane. The box
// comes
//             first in the test, ends it early, and keeps the volume bounded whatever the planes
//             do.
// Planes:     those of the hull that cut most off: to the box, the plane is added beyond which a
//             corner of what is left lies farthest, until nothing is cut or the planes are full
//             (fast: 12). Flat sets get the two sides of their plane and the edges of their
//             outline. Offsets are computed for the rounded normals from all points.
// Margins:    bound_margin.h.
// Measure:    of the polytope. merge(): around the corners of both.
// Thread safety: values.
#pragma once

#include <vector>

#include <strahl/bounds/aabb_volume.h>
#include <strahl/bounds/bounding_volume.h>
#include <strahl/bounds/plane.h>

namespace strahl {

struct HullRay {
  AabbRay box;
  BoundRay planes;
  HullRay() = default;
  HullRay(const PreparedRay& ray, const Aabb& world) : box(ray, world), planes(ray, world) {}
};

class HullVolume {
 public:
  static constexpr BoundingVolumeKind kKind = BoundingVolumeKind::hull;
  static constexpr std::size_t kMostPlanes = 32;
  using RayData = HullRay;

  HullVolume() = default;
  static HullVolume enclose(const EnclosedSet& set, FitEffort effort = FitEffort::thorough);
  static HullVolume merge(const HullVolume& a, const HullVolume& b) {
    return merge_by_corners(a, b);
  }

  Interval clip(const HullRay& ray, Interval in) const {
    in = box_.clip(ray.box, in);
    for (const FacePlane& plane : planes_) {
      if (in.t_enter > in.t_exit) break;
      in = plane.clip(ray.planes, in);
    }
    return in;
  }
  double half_area() const { return measure().half_area; }
  double volume() const { return measure().volume; }
  bool contains(const Vec3d& p) const;
  std::size_t bytes() const { return sizeof(*this) + planes_.capacity() * sizeof(FacePlane); }
  Aabb box() const { return box_.box(); }
  void add_corners_to(EnclosedSet& set) const;
  void add_sides_to(SideList& sides) const;
  void add_planes_to(Polytope& body) const;

 private:
  Polytope::Measure measure() const;
  AabbVolume box_;
  std::vector<FacePlane> planes_;
};
static_assert(PolyhedralVolume<HullVolume>);

}  // namespace strahl
