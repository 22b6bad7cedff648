#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <strahl/bounds/minimal_ball.h>
#include <strahl/bounds/plane.h>
#include <strahl/bounds/shell_volume.h>

namespace strahl {
namespace {

constexpr int kNewtonSteps = 3;
constexpr double kFarCenter = 1e3;  // in sizes of the cloud: beyond, a shell is a slab
/// Sectors narrower than 60 degrees are enclosed by a pyramid, wider ones by their ball.
constexpr double kNarrowCosine = 0.5;

/// w.a / |w|, lowered by what a ball of this radius reaches around w; -2 where it holds the centre.
double least_cosine(const Vec3d& w, double radius, const Vec3d& a) {
  const double distance = length(w), norm = length(a);
  if (distance <= radius) return radius == 0.0 ? norm : -2.0;
  const double cosine = std::clamp(dot(w, a) / (distance * norm), -1.0, 1.0);
  if (radius == 0.0) return norm * cosine - kCornerMargin;
  const double angle = std::acos(cosine) + std::asin(radius / distance);
  return angle >= std::numbers::pi ? -2.0 : norm * std::cos(angle) - kCornerMargin;
}

/// Centres worth trying, in the cloud's units.
std::vector<Vec3d> center_candidates(const FitCloud& cloud, FitEffort effort) {
  const std::vector<Vec3d> points = cloud.surface_points();
  std::vector<Vec3d> centers{effort == FitEffort::thorough
                                 ? minimal_ball(cloud.points, cloud.balls).center
                                 : ritter_ball(cloud.points, cloud.balls).center};
  const Vec3d fitted = fitted_center(points);
  if (norm_max(fitted) < kFarCenter) centers.push_back(fitted);
  if (effort == FitEffort::fast) return centers;
  const Vec3d normal = principal_axes(points)[2];
  for (const double far : {1.0, 2.0, 4.0})
    centers.push_back(far * normal), centers.push_back(-far * normal);
  return centers;
}

}  // namespace

Vec3d fitted_center(std::span<const Vec3d> points) {
  Vec3d mean, right;
  for (const Vec3d& p : points) mean = mean + p;
  mean = mean / static_cast<double>(points.size());
  Vec3d c0, c1, c2;  // columns of the covariance
  for (const Vec3d& p : points) {
    const Vec3d q = p - mean;
    c0 = c0 + q.x * q, c1 = c1 + q.y * q, c2 = c2 + q.z * q;
    right = right + dot(q, q) * q;
  }
  const double determinant = dot(c0, cross(c1, c2));
  const double trace = c0.x + c1.y + c2.z;
  if (!(determinant > 1e-12 * trace * trace * trace)) return Vec3d::all(NAN);
  const Vec3d solution{dot(right, cross(c1, c2)), dot(c0, cross(right, c2)),
                       dot(c0, cross(c1, right))};
  return mean + (0.5 / determinant) * solution;
}

ShellVolume ShellVolume::everything() {
  ShellVolume v;
  v.outer_ = std::numeric_limits<float>::infinity();
  return v;
}

ShellVolume ShellVolume::around(const EnclosedSet& set, const Vec3d& center) {
  ShellVolume v;
  v.center_ = {float_nearest(center.x), float_nearest(center.y), float_nearest(center.z)};
  if (!is_finite(v.center_)) return everything();
  v.outer_ = float_above(set.farthest_from(Vec3d(v.center_)));
  v.inner_ = float_below(set.nearest_to(Vec3d(v.center_)));
  v.fit_sector(set);
  return v;
}

void ShellVolume::fit_sector(const EnclosedSet& set) {
  const Vec3d c(center_);
  std::vector<Vec3d> directions;
  for (const Vec3d& p : set.points())
    if (!(p == c)) directions.push_back(unit(p - c));
  for (const Ball& b : set.balls())
    if (!(b.center == c)) directions.push_back(unit(b.center - c));
  const Vec3d middle = minimal_ball(directions).center;
  if (!(norm_max(middle) > 1e-6)) return;
  axis_ = rounded_normal(unit(middle));
  double least = 2.0;
  for (const Vec3d& p : set.points())
    least = std::min(least, least_cosine(p - c, 0.0, Vec3d(axis_)));
  for (const Ball& b : set.balls())
    least = std::min(least, least_cosine(b.center - c, b.radius, Vec3d(axis_)));
  if (least > 0.0) cosine_ = float_below(least);
}

ShellVolume ShellVolume::enclose(const EnclosedSet& set, FitEffort effort) {
  if (set.is_unbounded()) return everything();
  ShellVolume best;
  if (set.is_empty()) return best;
  const FitCloud cloud(set);
  for (const Vec3d& center : center_candidates(cloud, effort)) {
    const ShellVolume v = around(set, cloud.to_original(center));
    if (best.outer_ < 0.0f || v.half_area() < best.half_area()) best = v;
  }
  return best;
}

ShellVolume ShellVolume::merge(const ShellVolume& a, const ShellVolume& b) {
  if (a.outer_ < 0.0f) return b;
  if (b.outer_ < 0.0f) return a;
  EnclosedSet both;
  a.add_corners_to(both), b.add_corners_to(both);
  if (both.is_unbounded()) return everything();
  ShellVolume best = enclose(both, FitEffort::fast);
  for (const Vec3f& center : {a.center_, b.center_}) {
    const ShellVolume v = around(both, Vec3d(center));
    if (v.half_area() < best.half_area()) best = v;
  }
  return best;
}

Interval ShellVolume::clip_to_sector(const BoundRay& ray, const NearLine& near, Interval v) const {
  const Vec3d a(axis_), d = ray.unit_dir;
  const double k = cosine_, rise = dot(d, a);
  double* const end[2] = {&v.t_enter, &v.t_exit};
  for (int side = 0; side < 2; ++side) {
    const double inward = side == 0 ? 1.0 : -1.0;
    for (int step = 0; step < kNewtonSteps; ++step) {
      const Vec3d w = near.offset + *end[side] * d;
      const double distance = length(w);
      const double f = dot(w, a) - k * distance + 2.5 * near.slack;
      if (!(f < 0.0)) break;
      const double slope = inward * (rise - k * dot(w, d) / distance) + 0x1p-40;
      if (slope <= 0.0) return kNoInterval;
      *end[side] -= inward * f / slope;
      if (v.t_enter > v.t_exit) return kNoInterval;
    }
  }
  return v;
}

Interval ShellVolume::clip(const BoundRay& ray, Interval in) const {
  if (outer_ < 0.0f) return kNoInterval;
  const NearLine near(ray, Vec3d(center_), outer_);
  const double squared = near.squared_half_chord(outer_);
  if (squared < 0.0) return kNoInterval;
  const double half = std::sqrt(squared) + near.slack;
  Interval v{-half, half};
  if (!is_whole()) v = clip_to_sector(ray, near, v);
  v = near.part_of(ray, in, v);
  const double inner = inner_ - near.slack;
  const double hole = std::sqrt(inner * inner - dot(near.offset, near.offset)) - near.slack;
  if (inner > 0.0 && hole > 0.0) {
    if (-hole < v.t_enter && v.t_enter < hole) v.t_enter = hole;
    if (-hole < v.t_exit && v.t_exit < hole) v.t_exit = -hole;
  }
  if (v.t_enter > v.t_exit) return kNoInterval;
  return near.cut(ray, v.t_enter, v.t_exit, in);
}

double ShellVolume::half_area() const {
  if (outer_ < 0.0f) return 0.0;
  const double outer = outer_, inner = inner_;
  if (is_whole()) return 2.0 * std::numbers::pi * outer * outer;
  const double cosine = std::min(1.0, cosine_ / length(Vec3d(axis_)));
  const double sine = std::sqrt(1.0 - cosine * cosine);
  return 0.5 * std::numbers::pi *
         (2.0 * outer * outer * (1.0 - cosine) + sine * (outer * outer - inner * inner) +
          inner * inner * sine * sine);
}

double ShellVolume::volume() const {
  if (outer_ < 0.0f) return 0.0;
  const double outer = outer_, inner = inner_;
  const double share = is_whole() ? 2.0 : 1.0 - std::min(1.0, cosine_ / length(Vec3d(axis_)));
  return 2.0 / 3.0 * std::numbers::pi * share * (outer * outer * outer - inner * inner * inner);
}

bool ShellVolume::contains(const Vec3d& p) const {
  const Vec3d w = p - Vec3d(center_);
  const double distance = length(w);
  return inner_ <= distance && distance <= outer_ &&
         (is_whole() || dot(w, Vec3d(axis_)) >= cosine_ * distance);
}

void ShellVolume::add_corners_to(EnclosedSet& set) const {
  if (outer_ < 0.0f) return;
  if (std::isinf(outer_)) return set.add_corner(Vec3d::all(Aabb::kInf));
  const Vec3d c(center_), a(axis_);
  const double cosine = cosine_ / length(a);
  const Layer layer{c, inner_, outer_};
  if (is_whole() || cosine < kNarrowCosine) return set.add(layer);
  const Basis basis(a);
  const double more = kSupportMargin * norm_max(c) + kCornerMargin * outer_;
  const double tangent = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) / cosine;
  constexpr int kSides = 12;
  for (const double height : {inner_ * cosine - more, outer_ + more}) {
    const double r =
        (std::max(height, 0.0) * tangent + 4.0 * more) / std::cos(std::numbers::pi / kSides);
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2 * std::numbers::pi * i / kSides;
      set.add_outline(c + height * basis.w + (r * std::cos(angle)) * basis.u +
                      (r * std::sin(angle)) * basis.v);
    }
  }
  set.add_surface(layer);
}

void ShellVolume::add_sides_to(SideList& sides) const {
  const Vec3d c(center_), a(axis_);
  sides.add(VolumeSide::ball(c, outer_));
  if (inner_ > 0.0f) sides.add(VolumeSide::hole(c, inner_));
  if (!is_whole()) sides.add(VolumeSide::cone(c, unit(a), cosine_ / length(a), outer_));
}

}  // namespace strahl
