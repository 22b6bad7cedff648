#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <strahl/bounds/bound_margin.h>
#include <strahl/bounds/enclosed_set.h>
#include <strahl/bounds/fit.h>

namespace strahl {
namespace {

constexpr int kRim = 24;
constexpr double kConeInflation = 0x1p-20;
constexpr double kFlattestCone = 0x1p-10;

Vec3d nearest_on_segment(const Vec3d& a, const Vec3d& b, const Vec3d& p) {
  const Vec3d ab = b - a;
  const double squared = dot(ab, ab);
  if (!(squared > 0.0)) return a;
  return a + std::clamp(dot(p - a, ab) / squared, 0.0, 1.0) * ab;
}

double distance_to(const Capsule& capsule, const Vec3d& p) {
  return length(p - nearest_on_segment(capsule.a, capsule.b, p)) - capsule.radius;
}

/// Whether p projects into the triangle: on the inner side of each edge.
bool projects_inside(const TriangleVertices& tri, const Vec3d& n, const Vec3d& p) {
  return dot(cross(tri.b - tri.a, p - tri.a), n) >= 0.0 &&
         dot(cross(tri.c - tri.b, p - tri.b), n) >= 0.0 &&
         dot(cross(tri.a - tri.c, p - tri.c), n) >= 0.0;
}

}  // namespace

double distance_to(const TriangleVertices& tri, const Vec3d& p) {
  double least = Aabb::kInf;
  for (const auto& [a, b] : {std::pair{tri.a, tri.b}, {tri.b, tri.c}, {tri.c, tri.a}})
    least = std::min(least, length(p - nearest_on_segment(a, b, p)));
  const Vec3d n = cross(tri.b - tri.a, tri.c - tri.a);
  if (norm_max(n) > 0.0 && projects_inside(tri, n, p))
    least = std::min(least, std::abs(dot(p - tri.a, unit(n))));
  return least;
}

void EnclosedSet::add_corner(const Vec3d& point) {
  is_solid_ = true;
  add_outline(point);
}

void EnclosedSet::add_outline(const Vec3d& point) {
  if (!is_finite(point)) {
    is_unbounded_ = true;
    return;
  }
  points_.push_back(point);
  box_.extend(point);
}

void EnclosedSet::add(const Vec3d& point) {
  if (!is_finite(point)) return;
  add_outline(point);
  capsules_.push_back({point, point, 0.0});
}

void EnclosedSet::add(const TriangleVertices& tri) {
  if (!is_finite(tri.a) || !is_finite(tri.b) || !is_finite(tri.c)) return;
  triangles_.push_back(static_cast<std::uint32_t>(points_.size()));
  for (const Vec3d& v : {tri.a, tri.b, tri.c}) add_outline(v);
}

void EnclosedSet::add_ball(const Ball& ball, const Aabb& own_box) {
  balls_.push_back(ball);
  box_.extend(own_box);
}

void EnclosedSet::add(const Sphere& sphere) {
  const Aabb own = bounds(sphere);
  if (own.is_empty()) return;
  add_ball({sphere.center, sphere.radius}, own);
  layers_.push_back({sphere.center, sphere.radius, sphere.radius});
}

void EnclosedSet::add(const Ball& ball) {
  add_ball(ball, box_around(ball.center, Vec3d::all(ball.radius)));
  layers_.push_back({ball.center, 0.0, ball.radius});
}

void EnclosedSet::add(const Layer& layer) {
  add_ball({layer.center, layer.outer}, box_around(layer.center, Vec3d::all(layer.outer)));
  layers_.push_back(layer);
}

void EnclosedSet::add(const Aabb& box) {
  if (box.is_empty()) return;
  for (int corner = 0; corner < 8; ++corner)
    add_outline({(corner & 1 ? box.hi : box.lo).x, (corner & 2 ? box.hi : box.lo).y,
                 (corner & 4 ? box.hi : box.lo).z});
  layers_.push_back({box.center(), 0.0, 0.5 * length(box.extent())});
}

/// Corners of the regular polygon around a rim.
void EnclosedSet::add_rim(const Vec3d& center, double radius, const Vec3d& axis) {
  const Basis basis(axis);
  const double r = radius / std::cos(std::numbers::pi / kRim);
  for (int i = 0; i < kRim; ++i) {
    const double angle = 2 * std::numbers::pi * i / kRim;
    points_.push_back(center + (r * std::cos(angle)) * basis.u + (r * std::sin(angle)) * basis.v);
  }
}

void EnclosedSet::add(const Cone& cone) {
  const Aabb own = bounds(cone);
  if (own.is_empty()) return;
  const Vec3d span = cone.apex - cone.base;
  const double height = length(span), wide = std::max(cone.base_radius, cone.apex_radius);
  if (height < kFlattestCone * std::abs(cone.apex_radius - cone.base_radius)) return add(own);
  const double more = kConeInflation * (height + wide);
  add_rim(cone.base, cone.base_radius + more, span);
  add_rim(cone.apex, cone.apex_radius + more, span);
  box_.extend(own);
  capsules_.push_back({cone.base, cone.apex, wide + more});
}

void EnclosedSet::add(const PrimitiveSource& source, std::uint32_t i) {
  const Aabb box = source.bounds(i);
  if (box.is_empty()) return;
  const Outline outline = source.outline(i);
  const auto& ball = outline.ball;
  if (outline.is_triangle())
    add(TriangleVertices{ball[0].center, ball[1].center, ball[2].center});
  else if (outline.is_sphere())
    add(Sphere{ball[0].center, ball[0].radius});
  else if (outline.cone != nullptr)
    add(*outline.cone);
  else
    add(box);
}

void EnclosedSet::append(const EnclosedSet& other) {
  const auto shift = static_cast<std::uint32_t>(points_.size());
  points_.insert(points_.end(), other.points_.begin(), other.points_.end());
  balls_.insert(balls_.end(), other.balls_.begin(), other.balls_.end());
  for (const std::uint32_t first : other.triangles_) triangles_.push_back(first + shift);
  layers_.insert(layers_.end(), other.layers_.begin(), other.layers_.end());
  capsules_.insert(capsules_.end(), other.capsules_.begin(), other.capsules_.end());
  box_.extend(other.box_);
  is_unbounded_ = is_unbounded_ || other.is_unbounded_;
  is_solid_ = is_solid_ || other.is_solid_;
}

std::pair<double, double> EnclosedSet::extent(const Vec3d& n) const {
  double lo = Aabb::kInf, hi = -Aabb::kInf, reach = 0.0;
  const auto offer = [&](double at, double around, double size) {
    lo = std::min(lo, at - around), hi = std::max(hi, at + around);
    reach = std::max(reach, size);
  };
  for (const Vec3d& p : points_) offer(dot(n, p), 0.0, norm_max(p));
  const double norm = balls_.empty() ? 0.0 : length(n);
  for (const Ball& b : balls_)
    offer(dot(n, b.center), b.radius * norm, norm_max(b.center) + b.radius);
  const double margin = kSupportMargin * norm1(n) * reach;
  return {lo - margin, hi + margin};
}

double EnclosedSet::farthest_from(const Vec3d& center) const {
  double most = 0.0;
  for (const Vec3d& p : points_) most = std::max(most, length(p - center));
  for (const Ball& b : balls_) most = std::max(most, length(b.center - center) + b.radius);
  return most * (1.0 + kDistanceMargin);
}

double EnclosedSet::nearest_to(const Vec3d& center) const {
  if (is_solid_) return 0.0;
  double least = Aabb::kInf, reach = 0.0;
  const auto offer = [&](double distance, double size) {
    least = std::min(least, distance), reach = std::max(reach, size);
  };
  for (const std::uint32_t first : triangles_) {
    const TriangleVertices tri{points_[first], points_[first + 1], points_[first + 2]};
    offer(distance_to(tri, center), length(tri.a - center) + norm_max(tri.bounds().extent()));
  }
  for (const Layer& l : layers_) {
    const double d = length(l.center - center);
    offer(std::max(d - l.outer, l.inner - d), d + l.outer);
  }
  for (const Capsule& c : capsules_)
    offer(distance_to(c, center), length(c.a - center) + length(c.b - c.a) + c.radius);
  // A triangle of height h is known to about 2^-51 / h and to h^2 / 2 least: at most 2^-30 together
  // where the centre keeps away; where it does not, there is no hole worth having.
  return least < 0x1p-12 * reach ? 0.0 : least - 0x1p-26 * reach;
}

}  // namespace strahl
