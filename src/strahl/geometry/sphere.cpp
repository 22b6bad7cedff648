#include <cmath>

#include <strahl/geometry/sphere.h>
#include <strahl/math/coordinate.h>
#include <strahl/math/expansion.h>

namespace strahl {
namespace {

bool can_be_hit(const Sphere& sphere) {
  return is_coordinate(sphere.center) && sphere.radius > 0.0 && is_coordinate(sphere.radius);
}

/// r^2 - p.p, relative to r^2 within a few 2^-104.
double squared_half_chord(double radius, const LinePoint& p) {
  TwoTerms square[3];
  for (int axis = 0; axis < 3; ++axis) {
    square[axis] = two_product(p.high[axis], p.high[axis]);
    square[axis].low += 2.0 * p.high[axis] * p.low[axis];
  }
  const TwoTerms radius2 = two_product(radius, radius);
  const TwoTerms xy = two_sum(square[0].high, square[1].high);
  const TwoTerms xyz = two_sum(xy.high, square[2].high);
  const TwoTerms rest = two_sum(radius2.high, -xyz.high);
  const double low = (square[0].low + square[1].low) + (square[2].low + (xy.low + xyz.low));
  return rest.high + (rest.low + (radius2.low - low));
}

}  // namespace

Aabb bounds(const Sphere& sphere) {
  if (!can_be_hit(sphere)) return {};
  return box_around(sphere.center, Vec3d::all(sphere.radius));
}

Aabb clip(const Sphere& sphere, const Aabb& box) { return Aabb::intersection(bounds(sphere), box); }

CurvedHits intersect(const Sphere& sphere, const Vec3d& org, const Vec3d& dir) {
  CurvedHits hits;
  if (!can_be_hit(sphere)) return hits;
  const LinePoint p = nearest_point(org, dir, sphere.center, {});
  const double squared = squared_half_chord(sphere.radius, p);
  if (!(squared > 0.0)) return hits;
  const double half = std::sqrt(squared) / length(dir);
  hits.hit = {CurvedHit{p.t + (p.dt - half), true}, CurvedHit{p.t + (p.dt + half), false}};
  hits.count = 2;
  return hits;
}

Vec3d normal_at(const Sphere& sphere, const Vec3d& org, const Vec3d& dir, double t) {
  const Vec3d p = point_at(org, dir, t, sphere.center).high;
  return unit(p == Vec3d() ? -dir : p);
}

}  // namespace strahl
