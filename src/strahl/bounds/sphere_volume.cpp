#include <cmath>
#include <numbers>

#include <strahl/bounds/minimal_ball.h>
#include <strahl/bounds/sphere_volume.h>
#include <strahl/math/float_round.h>

namespace strahl {

SphereVolume SphereVolume::everything() {
  SphereVolume v;
  v.radius_ = std::numeric_limits<float>::infinity();
  return v;
}

SphereVolume SphereVolume::enclose(const EnclosedSet& set, FitEffort effort) {
  if (set.is_unbounded()) return everything();
  SphereVolume v;
  if (set.is_empty()) return v;
  const FitCloud cloud(set);
  const Ball ball = effort == FitEffort::thorough ? minimal_ball(cloud.points, cloud.balls)
                                                  : ritter_ball(cloud.points, cloud.balls);
  const Vec3d c = cloud.to_original(ball.center);
  v.center_ = {float_nearest(c.x), float_nearest(c.y), float_nearest(c.z)};
  if (!is_finite(v.center_)) return everything();
  v.radius_ = float_above(set.farthest_from(Vec3d(v.center_)));
  return v;
}

SphereVolume SphereVolume::merge(const SphereVolume& a, const SphereVolume& b) {
  if (a.radius_ < 0.0f) return b;
  if (b.radius_ < 0.0f) return a;
  const double d = length(Vec3d(b.center_) - Vec3d(a.center_)) * (1.0 + kDistanceMargin);
  if (d + b.radius_ <= a.radius_) return a;
  if (d + a.radius_ <= b.radius_) return b;
  return merge_by_corners(a, b);
}

double SphereVolume::half_area() const {
  const double r = radius_;
  return r < 0.0 ? 0.0 : 2.0 * std::numbers::pi * r * r;
}

double SphereVolume::volume() const {
  const double r = radius_;
  return r < 0.0 ? 0.0 : 4.0 / 3.0 * std::numbers::pi * r * r * r;
}

void SphereVolume::add_corners_to(EnclosedSet& set) const {
  if (radius_ < 0.0f) return;
  if (std::isinf(radius_)) return set.add_corner(Vec3d::all(Aabb::kInf));
  set.add(ball());
}

void SphereVolume::add_sides_to(SideList& sides) const {
  sides.add(VolumeSide::ball(Vec3d(center_), radius_));
}

}  // namespace strahl
