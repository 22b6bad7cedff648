// math/aabb.h - closed axis-aligned boxes in double precision.
//
// Invariant: a box is empty exactly when lo > hi on some axis; Aabb{} is empty.
#pragma once

#include <limits>

#include <strahl/math/vec3.h>

namespace strahl {

/// Closed box [lo, hi]. Boxes of float or double vertices are exact: no rounding happens.
struct Aabb {
  static constexpr double kInf = std::numeric_limits<double>::infinity();
  Vec3d lo = Vec3d::all(kInf), hi = Vec3d::all(-kInf);

  constexpr bool is_empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  constexpr void extend(const Vec3d& p) { lo = min(lo, p), hi = max(hi, p); }
  constexpr void extend(const Aabb& b) { lo = min(lo, b.lo), hi = max(hi, b.hi); }
  constexpr Vec3d extent() const { return hi - lo; }
  constexpr Vec3d center() const { return 0.5 * lo + 0.5 * hi; }
  constexpr bool contains(const Vec3d& p) const {
    return lo.x <= p.x && p.x <= hi.x && lo.y <= p.y && p.y <= hi.y && lo.z <= p.z && p.z <= hi.z;
  }
  constexpr bool contains(const Aabb& b) const { return contains(b.lo) && contains(b.hi); }
  /// Closed: touching counts.
  constexpr bool overlaps(const Aabb& b) const { return !intersection(*this, b).is_empty(); }
  /// Half of the surface area; 0 for an empty box.
  constexpr double half_area() const {
    if (is_empty()) return 0.0;
    const Vec3d e = extent();
    return e.x * e.y + e.y * e.z + e.z * e.x;
  }
  /// Axis of the largest extent, the lowest one on ties.
  constexpr int longest_axis() const {
    const Vec3d e = extent();
    return e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
  }
  static constexpr Aabb intersection(const Aabb& a, const Aabb& b) {
    return {max(a.lo, b.lo), min(a.hi, b.hi)};
  }
  static constexpr Aabb join(const Aabb& a, const Aabb& b) {
    return {min(a.lo, b.lo), max(a.hi, b.hi)};
  }
  constexpr bool operator==(const Aabb&) const = default;
};

}  // namespace strahl
