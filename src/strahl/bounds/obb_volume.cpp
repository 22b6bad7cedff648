#include <algorithm>
#include <cmath>

#include <strahl/bounds/obb_volume.h>
#include <strahl/bounds/polytope.h>

namespace strahl {

ObbVolume ObbVolume::around(const EnclosedSet& set, const ObbAxes& axes) {
  ObbVolume v;
  if (set.is_empty()) return v;
  for (std::size_t i = 0; i < 3; ++i) {
    v.slab_[i] = Slab::around(set, axes[i]);
    constexpr float kEndless = std::numeric_limits<float>::infinity();
    if (set.is_unbounded()) v.slab_[i].lo = -kEndless, v.slab_[i].hi = kEndless;
  }
  return v;
}

ObbVolume ObbVolume::enclose(const EnclosedSet& set, FitEffort effort, ObbGoal goal) {
  const FitCloud cloud(set, effort == FitEffort::thorough);
  return around(set, search_axes(cloud, goal, effort));
}

ObbVolume ObbVolume::enclose_by_covariance(const EnclosedSet& set) {
  return around(set, covariance_axes(FitCloud(set, true)));
}

ObbVolume ObbVolume::merge(const ObbVolume& a, const ObbVolume& b) {
  if (a.is_empty()) return b;
  if (b.is_empty()) return a;
  EnclosedSet both;
  a.add_corners_to(both), b.add_corners_to(both);
  ObbVolume best = enclose(both, FitEffort::fast);
  for (const ObbAxes& axes : {a.axes(), b.axes()}) {
    const ObbVolume v = around(both, axes);
    if (v.half_area() < best.half_area()) best = v;
  }
  return best;
}

ObbAxes ObbVolume::axes() const {
  return {unit(Vec3d(slab_[0].n)), unit(Vec3d(slab_[1].n)), unit(Vec3d(slab_[2].n))};
}

double ObbVolume::half_area() const {
  if (is_empty()) return 0.0;
  return box_cost({slab_[0].width(), slab_[1].width(), slab_[2].width()}, ObbGoal::area);
}

double ObbVolume::volume() const {
  return is_empty() ? 0.0 : slab_[0].width() * slab_[1].width() * slab_[2].width();
}

bool ObbVolume::contains(const Vec3d& p) const {
  return std::all_of(slab_.begin(), slab_.end(), [&](const Slab& s) { return s.contains(p); });
}

Aabb ObbVolume::box() const {
  EnclosedSet corners;
  add_corners_to(corners);
  if (corners.is_unbounded()) return {Vec3d::all(-Aabb::kInf), Vec3d::all(Aabb::kInf)};
  return corners.box();
}

/// Solves n_i.x = plane_i by Cramer's rule for the corners of the box with planes moved out, which
/// covers the rounding: the normals are nearly orthogonal.
void ObbVolume::add_corners_to(EnclosedSet& set) const {
  if (is_empty()) return;
  const Vec3d n0(slab_[0].n), n1(slab_[1].n), n2(slab_[2].n);
  const Vec3d d0 = cross(n1, n2), d1 = cross(n2, n0), d2 = cross(n0, n1);
  const double determinant = dot(n0, d0);
  double reach = 0.0;
  for (const Slab& s : slab_)
    reach = std::max({reach, std::abs(double{s.lo}), std::abs(double{s.hi})});
  const auto plane = [&](std::size_t i, bool high) {
    return high ? slab_[i].hi + kCornerMargin * reach : slab_[i].lo - kCornerMargin * reach;
  };
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vec3d sum =
        plane(0, corner & 1) * d0 + plane(1, corner & 2) * d1 + plane(2, corner & 4) * d2;
    set.add_corner(sum / determinant);
  }
}

void ObbVolume::add_planes_to(Polytope& body) const {
  for (const Slab& s : slab_) body.add(Vec3d(s.n), s.hi), body.add(-Vec3d(s.n), -double{s.lo});
}

void ObbVolume::add_sides_to(SideList& sides) const {
  for (const Slab& s : slab_) sides.add_slab(Vec3d(s.n), s.lo, s.hi);
}

}  // namespace strahl
