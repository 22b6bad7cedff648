// bounds/sphere_volume.h - the sphere: smallest storage and smallest test.
//
// Papers:     [Welzl1991], [Gaertner1999], [Ritter1990], see minimal_ball.h.
// Layout:     centre and radius as floats, 16 bytes. The centre is rounded to nearest, the radius
// is
//             then measured from it and rounded up; radius < 0 is empty.
// Margins:    near_line.h.
// Measure:    exact of the stored sphere. merge() is the smallest sphere around both.
// Thread safety: values.
#pragma once

#include <strahl/bounds/bounding_volume.h>
#include <strahl/bounds/near_line.h>

namespace strahl {

/// BoundRay as the RayData of volumes that need nothing else.
struct PlainRay : BoundRay {
  PlainRay() = default;
  PlainRay(const PreparedRay& ray, const Aabb& world) : BoundRay(ray, world) {}
};

class SphereVolume {
 public:
  static constexpr BoundingVolumeKind kKind = BoundingVolumeKind::sphere;
  using RayData = PlainRay;

  SphereVolume() = default;
  /// Minimal where the effort is thorough, else Ritter's.
  static SphereVolume enclose(const EnclosedSet& set, FitEffort effort = FitEffort::thorough);
  static SphereVolume merge(const SphereVolume& a, const SphereVolume& b);
  static SphereVolume everything();

  Interval clip(const BoundRay& ray, Interval in) const {
    if (radius_ < 0.0f) return kNoInterval;
    const NearLine near(ray, Vec3d(center_), radius_);
    const double squared = near.squared_half_chord(radius_);
    if (squared < 0.0) return kNoInterval;
    const double half = std::sqrt(squared) + near.slack;
    return near.cut(ray, -half, half, in);
  }
  Ball ball() const { return {Vec3d(center_), radius_}; }
  double half_area() const;
  double volume() const;
  bool contains(const Vec3d& p) const { return length(p - Vec3d(center_)) <= radius_; }
  std::size_t bytes() const { return sizeof(*this); }
  void add_corners_to(EnclosedSet& set) const;
  void add_sides_to(SideList& sides) const;

 private:
  Vec3f center_;
  float radius_ = -1.0f;
};
static_assert(sizeof(SphereVolume) == 16 && BoundingVolume<SphereVolume>);

}  // namespace strahl
