// bounds/shell_volume.h - a sector of a spherical shell, for curved sheets.
//
// Paper:      [Krishnan1998]. {c + w : inner <= |w| <= outer, w within an angle of the axis}, the
// angle
//             at most 90 degrees, or the whole shell.
// Layout:     centre, axis a, inner and outer radius, cosine k as floats, 36 bytes. The sector is
//             w.a >= k |w| for the rounded axis; k = -2 is the whole shell, outer < 0 is empty.
// Fit:        centres tried: that of the sphere fitted to the points by least squares, points far
//             off the sheet on either side, the middle of the smallest ball; the smallest measure
//             wins. The axis is that of the smallest ball around the directions of the points. The
//             inner radius is that of the surfaces, not only of their vertices.
// Margins:    near_line.h. f(v) = w.a - k |w| is concave along the ray, so its tangent at a point
//             outside lies above it, and where the tangent reaches 0 is still outside: Newton's
//             steps from both ends never pass the sector. f is off by less than 2.5 S. What lies
//             inside the inner sphere lowered by S is skipped at the ends: a ray through the hole
//             keeps one interval from first entry to last exit.
// Measure:    that of the hull of the sector with its hole, an upper bound of the chance to be hit.
// merge():    a shell around the layers of both; concentric ones stay thin.
// Thread safety: values.
#pragma once

#include <strahl/bounds/bounding_volume.h>
#include <strahl/bounds/sphere_volume.h>

namespace strahl {

class ShellVolume {
 public:
  static constexpr BoundingVolumeKind kKind = BoundingVolumeKind::shell;
  using RayData = PlainRay;

  ShellVolume() = default;
  static ShellVolume enclose(const EnclosedSet& set, FitEffort effort = FitEffort::thorough);
  static ShellVolume merge(const ShellVolume& a, const ShellVolume& b);
  static ShellVolume everything();

  Interval clip(const BoundRay& ray, Interval in) const;
  double half_area() const;
  double volume() const;
  bool contains(const Vec3d& p) const;
  std::size_t bytes() const { return sizeof(*this); }
  /// Exact layers only where the whole shell is kept; else the corners of a pyramid around the
  /// sector, and its layer.
  void add_corners_to(EnclosedSet& set) const;
  void add_sides_to(SideList& sides) const;

 private:
  static constexpr float kWhole = -2.0f;
  static ShellVolume around(const EnclosedSet& set, const Vec3d& center);
  void fit_sector(const EnclosedSet& set);
  bool is_whole() const { return cosine_ == kWhole; }
  Interval clip_to_sector(const BoundRay& ray, const struct NearLine& near, Interval v) const;

  Vec3f center_, axis_{0, 0, 1};
  float inner_ = 0.0f, outer_ = -1.0f, cosine_ = kWhole;
};
static_assert(sizeof(ShellVolume) == 36 && BoundingVolume<ShellVolume>);

/// Centre of the sphere that fits points best in the least-squares sense of |p - c|^2 = const.
/// Infinite or NaN where the points are flat.
Vec3d fitted_center(std::span<const Vec3d> points);

}  // namespace strahl
