#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include <strahl/geometry/cone.h>
#include <strahl/math/coordinate.h>

namespace strahl {
namespace {

bool can_be_hit(const Cone& cone) {
  return is_coordinate(cone.base) && is_coordinate(cone.apex) && is_coordinate(cone.base_radius) &&
         is_coordinate(cone.apex_radius) && cone.base_radius >= 0.0 && cone.apex_radius >= 0.0 &&
         (cone.base_radius > 0.0 || cone.apex_radius > 0.0) && !(cone.base == cone.apex);
}

/// The power of two at or below a positive normal number.
double power_of_two_below(double v) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(v) & 0x7ff0000000000000u);
}

/// The cone with base at the origin, in units of `size`.
struct LocalCone {
  double size;         ///< power of two; the largest of radii and axis components is in [1, 2)
  Vec3d span;          ///< base to apex
  Vec3d axis;          ///< span times a power of two, largest component in [1, 2)
  double axis_length;  ///< of `axis`
  Vec3d unit_axis;     ///< span / |span|
  double base_radius;
  double cosine, sine;   ///< of the slope of the generator lines against the axis
  double squared_reach;  ///< no point of the surface is farther from the middle of the axis

  explicit LocalCone(const Cone& cone);
};

LocalCone::LocalCone(const Cone& cone) {
  const Vec3d w = cone.apex - cone.base;
  const double wide = std::max(cone.base_radius, cone.apex_radius);
  size = power_of_two_below(std::max(wide, norm_max(w)));
  span = w / size;
  const double stretch = power_of_two_below(norm_max(w));
  axis = w / stretch;
  axis_length = length(axis);
  unit_axis = axis / axis_length;
  base_radius = cone.base_radius / size;
  const double height = axis_length * (stretch / size);
  const double widening = (cone.apex_radius - cone.base_radius) / size;
  const double slant = std::sqrt(height * height + widening * widening);
  cosine = height / slant, sine = widening / slant;
  squared_reach = 0.25 * (height * height) + (wide / size) * (wide / size);
}

/// v without its component along the axis; exactly 0 for v parallel to it.
Vec3d across(const LocalCone& cone, const Vec3d& v) {
  return cross(cone.axis, cross(v, cone.axis)) / (cone.axis_length * cone.axis_length);
}

/// Roots of A u^2 + 2 B u + C given R = sqrt(B^2 - A C) > 0; infinite or NaN where there is none.
struct Roots {
  double front, back;  ///< where the quadratic falls, where it rises
};
Roots solve(double A, double B, double C, double R) {
  if (B >= 0.0) return {-(B + R) / A, -C / (B + R)};
  return {C / (R - B), (R - B) / A};
}

/// Roots in u of P + u*dir on the double cone that extends the surface; NaN where there is none.
Roots double_cone_roots(const LocalCone& cone, const Vec3d& P, const Vec3d& dir) {
  const Vec3d D = across(cone, dir), Q = across(cone, P);
  const double c = cone.cosine;
  const double e = c * cone.base_radius + cone.sine * dot(P, cone.unit_axis);
  const double g = cone.sine * dot(dir, cone.unit_axis);
  const double reach = length(e * D - g * Q);
  const double miss = c * std::abs(dot(cone.unit_axis, cross(D, Q)));
  const double discriminant = (reach - miss) * (reach + miss);
  if (!(discriminant > 0.0)) return {NAN, NAN};
  const double cD = c * length(D), cQ = c * length(Q);
  return solve((cD - g) * (cD + g), c * c * dot(Q, D) - g * e, (cQ - e) * (cQ + e),
               c * std::sqrt(discriminant));
}

}  // namespace

Aabb bounds(const Cone& cone) {
  if (!can_be_hit(cone)) return {};
  const Vec3d w = cone.apex - cone.base;
  const double height = length(w);
  Vec3d base_half, apex_half;
  for (int axis = 0; axis < 3; ++axis) {
    const double v1 = w[(axis + 1) % 3], v2 = w[(axis + 2) % 3];
    // A disc reaches r * sqrt(1 - a^2) along an axis. Differences, squares, sums, roots, quotient
    // and product leave a relative error below 10 * 2^-53; the factor adds 16 of them.
    const double part = std::sqrt(v1 * v1 + v2 * v2) / height * (1.0 + 0x1p-49);
    base_half[axis] = std::min(cone.base_radius, cone.base_radius * part);
    apex_half[axis] = std::min(cone.apex_radius, cone.apex_radius * part);
  }
  return Aabb::join(box_around(cone.base, base_half), box_around(cone.apex, apex_half));
}

Aabb clip(const Cone& cone, const Aabb& box) { return Aabb::intersection(bounds(cone), box); }

CurvedHits intersect(const Cone& cone, const Vec3d& org, const Vec3d& dir) {
  CurvedHits hits;
  if (!can_be_hit(cone)) return hits;
  const LocalCone local(cone);
  const LinePoint nearest = nearest_point(org, dir, cone.base, 0.5 * (cone.apex - cone.base));
  const Vec3d P = nearest.high / local.size;
  const Vec3d from_middle = P - 0.5 * local.span;
  // A line that stays away from the surrounding ball by far more than rounding misses.
  if (!(dot(from_middle, from_middle) <= local.squared_reach * 1.001)) return hits;

  const double dir_scale = power_of_two_below(norm_max(dir));
  const Vec3d unit_dir = dir / dir_scale;
  const Roots roots = double_cone_roots(local, P, unit_dir);
  const double top = dot(local.span, local.axis), start = dot(P, local.axis),
               slope = dot(unit_dir, local.axis);
  const auto offer = [&](double u, bool is_front) {
    const double along = start + u * slope;
    if (!(along >= 0.0 && along <= top)) return;
    const double t = nearest.t + (nearest.dt + u * (local.size / dir_scale));
    hits.hit[static_cast<std::size_t>(hits.count++)] = {t, is_front};
  };
  offer(roots.front, true);
  offer(roots.back, false);
  if (hits.count == 2 && hits.hit[1].t < hits.hit[0].t) std::swap(hits.hit[0], hits.hit[1]);
  return hits;
}

Vec3d normal_at(const Cone& cone, const Vec3d& org, const Vec3d& dir, double t) {
  const LocalCone local(cone);
  const Vec3d out = across(local, point_at(org, dir, t, cone.base).high);
  if (out == Vec3d()) return unit(-dir);
  return unit(local.cosine * unit(out) - local.sine * local.unit_axis);
}

}  // namespace strahl
