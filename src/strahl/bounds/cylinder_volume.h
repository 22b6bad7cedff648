// bounds/cylinder_volume.h - the capped cylinder, for long things.
//
// Papers:     [Weghorst1984]. The axis is searched among principal axes, far points and fixed
//             directions, then by small turns (thorough); across it lies the smallest circle
//             [Welzl1991].
// Layout:     centre, axis, radius, half height as floats, 32 bytes. The axis a is a unit vector
//             rounded; radius and half height are those of |(x - c) x a| and |(x - c).a|, rounded
//             up, so its length does not matter. radius < 0 is empty.
// Margins:    from the point of the ray nearest the centre (near_line.h) all lengths are at most
//             R + H + S, so products with a are off by less than S = distance_slack +
//             2^-46 (R + H). The ray across the axis is P + v Q with P = e x a, Q = d x a; its
//             nearest approach E is off by a few u |P|, and the chord is handled as the sphere's.
//             |Q| < 2^-60 moves it by less than S: it is taken as parallel.
// Measure:    exact of the stored cylinder, up to the rounding of the axis.
// merge():    around the circumscribed 24-gons of the ends, up to 0.9 % wider than needed.
// Thread safety: values.
#pragma once

#include <strahl/bounds/bounding_volume.h>
#include <strahl/bounds/sphere_volume.h>

namespace strahl {

class CylinderVolume {
 public:
  static constexpr BoundingVolumeKind kKind = BoundingVolumeKind::cylinder;
  using RayData = PlainRay;

  CylinderVolume() = default;
  static CylinderVolume enclose(const EnclosedSet& set, FitEffort effort = FitEffort::thorough);
  static CylinderVolume merge(const CylinderVolume& a, const CylinderVolume& b);
  static CylinderVolume everything();

  Interval clip(const BoundRay& ray, Interval in) const;
  double half_area() const;
  double volume() const;
  bool contains(const Vec3d& p) const;
  std::size_t bytes() const { return sizeof(*this); }
  void add_corners_to(EnclosedSet& set) const;
  void add_sides_to(SideList& sides) const;

 private:
  static CylinderVolume around(const EnclosedSet& set, const Vec3d& center, const Vec3d& axis);
  Vec3f center_, axis_{0, 0, 1};
  float radius_ = -1.0f, half_height_ = -1.0f;
};
static_assert(sizeof(CylinderVolume) == 32 && BoundingVolume<CylinderVolume>);

}  // namespace strahl
