#include <algorithm>
#include <cmath>

#include <strahl/structures/ray_classification/ray_cell.h>

namespace strahl {
namespace {

int dominant_axis(const Vec3d& dir) {
  const Vec3d d = abs(dir);
  return d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
}

/// How far a ray's point, in local units, may be from the ray: D being the distance of the origin,
/// at most 2^-48 D by the roundings of the entry (math/margin.h: 2^-50 of t, and the sum), 2^-45 D
/// by those of curved hits; the entry and the hit are both shifted by the widening of instances.
double slack_of(const PreparedRay& ray, const Vec3d& local_org, double scale) {
  const double widening = norm_max(ray.near_org - ray.org) * scale;
  return 0x1p-44 * (norm_max(local_org) + 2.0) + 2.0 * widening;
}

}  // namespace

RaySpace::RaySpace(const Aabb& box) : box_(box), center_(box.center()) {
  const Vec3d reach = max(abs(box.hi - center_), abs(box.lo - center_));
  // A box no larger than the rounding of its own coordinates gets units that can be inverted.
  const double far = std::max(norm_max(box.lo), norm_max(box.hi));
  const double unit = std::max({norm_max(reach), far * 0x1p-40, 0x1p-300});
  scale_ = std::ldexp(1.0, -1 - std::ilogb(unit));
  half_ = reach * scale_;
}

RayCell RaySpace::root() const {
  return {{-half_.x, -half_.y, -half_.z, -1.0, -1.0}, {half_.x, half_.y, half_.z, 1.0, 1.0}};
}

std::optional<RayPoint> RaySpace::classify(const PreparedRay& ray) const {
  const Interval span = clip_to_box(ray, box_.lo, box_.hi, {ray.t_enter, ray.t_exit});
  if (span.t_enter > span.t_exit) return std::nullopt;
  RayPoint point;
  const int axis = dominant_axis(ray.dir);
  point.face = 2 * axis + ray.negative[axis];
  const Vec3d org = local(ray.org);
  for (int a = 0; a < 3; ++a) {
    const double moved = org[a] + span.t_enter * ray.dir[a] * scale_;
    point.at[static_cast<std::size_t>(a)] = std::clamp(moved, -half_[a], half_[a]);
  }
  const double along = std::abs(ray.dir[axis]);
  point.at[3] = ray.dir[(axis + 1) % 3] / along;
  point.at[4] = ray.dir[(axis + 2) % 3] / along;
  point.is_certain = slack_of(ray, org, scale_) <= kRaySlack;
  return point;
}

}  // namespace strahl
