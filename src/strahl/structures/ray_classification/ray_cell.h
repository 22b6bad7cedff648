// structures/ray_classification/ray_cell.h - rays as points of a five-dimensional space, and the
// cells it is divided into.
//
// Source: [ArvoKirk1987].
// Coordinates: three of the ray's origin, two of its direction on one of the six faces of the
//   direction cube: face 2a is dir[a] > 0 dominant, 2a + 1 dir[a] < 0, ties go to the lower axis;
//   u, v are the next two components in cyclic order over |dir[a]|, in [-1, 1].
//   Origins are moved along their rays to where the scene's box, or the ray's interval, begins, and
//   are in local units: the scene's box lies around 0 within [-1, 1]^3.
// Exactness: only the place in a list is found with moved origins; hits are tested with the ray as
//   given. RayPoint::is_certain says that the line of the point and of the ray are within
//   kRaySlack of each other; for other rays, from millions of scene sizes away, cells mean nothing.
// Thread safety: values.
#pragma once

#include <array>
#include <optional>

#include <strahl/math/ray.h>

namespace strahl {

inline constexpr int kFaces = 6;

/// How far, in local units, a certain point's line may be from where its ray meets something, and
/// what that may add up to with the rounding of stored outlines.
inline constexpr double kRaySlack = 0x1p-20, kBeamSlack = 0x1p-19;

/// A ray as a point. at: origin x, y, z; u, v.
struct RayPoint {
  int face = 0;
  bool is_certain = false;
  std::array<double, 5> at{};
};

/// A cell of one face's space: closed intervals of the five coordinates.
struct RayCell {
  static constexpr unsigned kChildren = 32;
  std::array<double, 5> lo, hi;

  /// Halves all intervals, becomes the child that holds the point, and returns its number.
  unsigned descend(const RayPoint& point) {
    unsigned number = 0;
    for (std::size_t i = 0; i < 5; ++i) {
      const double middle = 0.5 * lo[i] + 0.5 * hi[i];
      const bool is_upper = point.at[i] >= middle;
      (is_upper ? lo : hi)[i] = middle;
      number |= static_cast<unsigned>(is_upper) << i;
    }
    return number;
  }
  RayCell child(unsigned number) const {
    RayCell cell = *this;
    for (std::size_t i = 0; i < 5; ++i)
      (number >> i & 1 ? cell.lo : cell.hi)[i] = 0.5 * lo[i] + 0.5 * hi[i];
    return cell;
  }
  bool contains(const RayPoint& point) const {
    for (std::size_t i = 0; i < 5; ++i)
      if (!(lo[i] <= point.at[i] && point.at[i] <= hi[i])) return false;
    return true;
  }
};

/// The scene's box with its local units.
class RaySpace {
 public:
  RaySpace() = default;
  /// @param box not empty
  explicit RaySpace(const Aabb& box);

  const Aabb& box() const { return box_; }
  Vec3d local(const Vec3d& p) const { return (p - center_) * scale_; }
  double local_length(double length) const { return length * scale_; }
  RayCell root() const;

  /// Where the ray belongs; empty when it certainly misses the box within its interval.
  std::optional<RayPoint> classify(const PreparedRay& ray) const;

 private:
  Aabb box_;
  Vec3d center_, half_;
  double scale_ = 1.0;  ///< a power of two
};

}  // namespace strahl
