#include <algorithm>
#include <cmath>

#include <strahl/geometry/curved.h>
#include <strahl/math/expansion.h>

namespace strahl {
namespace {

/// (high + low) += a * b, renormalised.
void add_product(double& high, double& low, double a, double b) {
  const TwoTerms product = two_product(a, b);
  const TwoTerms sum = two_sum(high, product.high);
  const TwoTerms result = two_sum(sum.high, sum.low + (low + product.low));
  high = result.high, low = result.low;
}

void advance(LinePoint& p, const Vec3d& dir, double dt) {
  for (int axis = 0; axis < 3; ++axis) add_product(p.high[axis], p.low[axis], dt, dir[axis]);
}

double rounded_down(double a, double b) {
  const TwoTerms sum = two_sum(a, b);
  return sum.low < 0.0 ? std::nextafter(sum.high, -Aabb::kInf) : sum.high;
}

}  // namespace

Interval canonical_slab(const Vec3d& org, const Vec3d& dir, const Aabb& box) {
  Interval slab{-Aabb::kInf, Aabb::kInf};
  for (int axis = 0; axis < 3; ++axis) {
    const bool negative = dir[axis] < 0.0;
    const double inv = dir[axis] == 0.0 ? Aabb::kInf : 1.0 / dir[axis];
    const double first = ((negative ? box.hi : box.lo)[axis] - org[axis]) * inv;
    const double last = ((negative ? box.lo : box.hi)[axis] - org[axis]) * inv;
    // Written so that a NaN leaves the interval as it is.
    slab.t_enter = first > slab.t_enter ? first : slab.t_enter;
    slab.t_exit = last < slab.t_exit ? last : slab.t_exit;
  }
  return slab;
}

CurvedHits tie_to_box(const CurvedHits& hits, const Vec3d& org, const Vec3d& dir, const Aabb& box) {
  const Interval slab = canonical_slab(org, dir, box);
  CurvedHits tied;
  if (!(slab.t_enter <= slab.t_exit)) return tied;
  for (int i = 0; i < hits.count; ++i) {
    CurvedHit hit = hits.hit[static_cast<std::size_t>(i)];
    if (!std::isfinite(hit.t)) continue;
    hit.t = std::clamp(hit.t, slab.t_enter, slab.t_exit) + 0.0;  // -0 + 0 is +0
    tied.hit[static_cast<std::size_t>(tied.count++)] = hit;
  }
  if (tied.count == 2 && tied.hit[0].t == tied.hit[1].t) tied.count = 0;
  return tied;
}

LinePoint point_at(const Vec3d& org, const Vec3d& dir, double t, const Vec3d& reference) {
  LinePoint p;
  p.t = t;
  for (int axis = 0; axis < 3; ++axis) {
    const TwoTerms d = two_sum(org[axis], -reference[axis]);
    p.high[axis] = d.high, p.low[axis] = d.low;
  }
  advance(p, dir, t);
  return p;
}

LinePoint nearest_point(const Vec3d& org, const Vec3d& dir, const Vec3d& reference,
                        const Vec3d& shift) {
  const double dir2 = dot(dir, dir);
  const double t = dot((reference - org) + shift, dir) / dir2;
  LinePoint p = point_at(org, dir, t, reference);
  // What the rounding of t left along the line.
  p.dt = dot(shift - p.high, dir) / dir2;
  advance(p, dir, p.dt);
  return p;
}

Aabb box_around(const Vec3d& center, const Vec3d& half_extent) {
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = rounded_down(center[axis], -half_extent[axis]);
    box.hi[axis] = -rounded_down(-center[axis], -half_extent[axis]);
  }
  return box;
}

}  // namespace strahl
