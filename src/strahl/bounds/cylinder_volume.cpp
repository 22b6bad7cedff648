#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <strahl/bounds/cylinder_volume.h>
#include <strahl/bounds/minimal_ball.h>
#include <strahl/bounds/plane.h>

namespace strahl {
namespace {

/// The cloud flattened along a unit axis, and its smallest circle.
Ball circle_across(const FitCloud& cloud, const Vec3d& axis) {
  std::vector<Vec3d> points = cloud.points;
  std::vector<Ball> balls = cloud.balls;
  for (Vec3d& p : points) p = p - dot(p, axis) * axis;
  for (Ball& b : balls) b.center = b.center - dot(b.center, axis) * axis;
  return minimal_ball(points, balls);
}

double cylinder_half_area(double radius, double height) {
  return std::numbers::pi * radius * (radius + height);
}

}  // namespace

CylinderVolume CylinderVolume::everything() {
  CylinderVolume v;
  v.radius_ = v.half_height_ = std::numeric_limits<float>::infinity();
  return v;
}

CylinderVolume CylinderVolume::around(const EnclosedSet& set, const Vec3d& center,
                                      const Vec3d& axis) {
  CylinderVolume v;
  v.center_ = {float_nearest(center.x), float_nearest(center.y), float_nearest(center.z)};
  v.axis_ = rounded_normal(axis);
  if (!is_finite(v.center_)) return everything();
  const Vec3d c(v.center_), a(v.axis_);
  const double norm = length(a);
  double across = 0.0, along = 0.0, reach = 0.0;
  const auto offer = [&](const Vec3d& p, double radius) {
    const Vec3d w = p - c;
    across = std::max(across, length(cross(w, a)) + radius * norm);
    along = std::max(along, std::abs(dot(w, a)) + radius * norm);
    reach = std::max(reach, norm_max(w) + radius);
  };
  for (const Vec3d& p : set.points()) offer(p, 0.0);
  for (const Ball& b : set.balls()) offer(b.center, b.radius);
  // w, its products with a and their sums: fewer than 8 roundings of terms below 2 |w|.
  v.radius_ = float_above(across + 0x1p-48 * reach);
  v.half_height_ = float_above(along + 0x1p-48 * reach);
  return v;
}

CylinderVolume CylinderVolume::enclose(const EnclosedSet& set, FitEffort effort) {
  if (set.is_unbounded()) return everything();
  if (set.is_empty()) return {};
  const FitCloud cloud(set);
  const auto cost = [&](const Vec3d& axis) {
    const auto [lo, hi] = cloud.extent(axis);
    return cylinder_half_area(circle_across(cloud, axis).radius, hi - lo);
  };
  const Vec3d axis = best_axis(axis_candidates(cloud, effort), effort, cost).axis;
  const auto [lo, hi] = cloud.extent(axis);
  const Vec3d middle = circle_across(cloud, axis).center;
  const Vec3d center = middle - dot(middle, axis) * axis + 0.5 * (lo + hi) * axis;
  return around(set, cloud.to_original(center), axis);
}

CylinderVolume CylinderVolume::merge(const CylinderVolume& a, const CylinderVolume& b) {
  if (a.radius_ < 0.0f) return b;
  if (b.radius_ < 0.0f) return a;
  return merge_by_corners(a, b);
}

Interval CylinderVolume::clip(const BoundRay& ray, Interval in) const {
  if (radius_ < 0.0f) return kNoInterval;
  const Vec3d a(axis_);
  const NearLine near(ray, Vec3d(center_), double{radius_} + double{half_height_});
  const double S = near.slack, r = radius_ + S;
  const Vec3d P = cross(near.offset, a), Q = cross(ray.unit_dir, a);
  const double squared = dot(Q, Q);
  const bool is_parallel = squared < 0x1p-120;
  const double middle = is_parallel ? 0.0 : -dot(P, Q) / squared;
  const Vec3d E = P + middle * Q;
  const double left = r * r - dot(E, E);
  if (left < 0.0) return kNoInterval;
  const double half = is_parallel ? Aabb::kInf : (std::sqrt(left) + S) / std::sqrt(squared);
  const SlabRay along(dot(near.offset, a), dot(ray.unit_dir, a), 1.75 * S);
  const Interval v =
      clip_to_slab(along, -double{half_height_}, half_height_, {middle - half, middle + half});
  return near.cut(ray, v.t_enter, v.t_exit, in);
}

double CylinderVolume::half_area() const {
  return radius_ < 0.0f ? 0.0 : cylinder_half_area(radius_, 2.0 * half_height_);
}

double CylinderVolume::volume() const {
  const double r = radius_;
  return r < 0.0 ? 0.0 : std::numbers::pi * r * r * 2.0 * half_height_;
}

bool CylinderVolume::contains(const Vec3d& p) const {
  const Vec3d w = p - Vec3d(center_), a(axis_);
  return length(cross(w, a)) <= radius_ && std::abs(dot(w, a)) <= half_height_;
}

void CylinderVolume::add_corners_to(EnclosedSet& set) const {
  if (radius_ < 0.0f) return;
  if (std::isinf(radius_) || std::isinf(half_height_))
    return set.add_corner(Vec3d::all(Aabb::kInf));
  const Vec3d a(axis_);
  const Basis basis(a);
  constexpr int kRim = 24;
  // Lengths are in units of |a|, and the polygon goes around the circle; both up to rounding.
  const double raise = (1.0 + kCornerMargin) / length(a);
  const double more = kSupportMargin * norm_max(Vec3d(center_));
  const double r = radius_ * raise / std::cos(std::numbers::pi / kRim) + more;
  const double height = half_height_ * raise + more;
  for (const double h : {-height, height}) {
    for (int i = 0; i < kRim; ++i) {
      const double angle = 2 * std::numbers::pi * i / kRim;
      set.add_corner(Vec3d(center_) + h * basis.w + (r * std::cos(angle)) * basis.u +
                     (r * std::sin(angle)) * basis.v);
    }
  }
}

/// radius_ and half_height_ are in units of the axis, which is nearly unit.
void CylinderVolume::add_sides_to(SideList& sides) const {
  const Vec3d c(center_), a(axis_);
  const double along = dot(a, c);
  sides.add(VolumeSide::tube(c, unit(a), radius_ / length(a)));
  sides.add_slab(a, along - half_height_, along + half_height_);
}

}  // namespace strahl
