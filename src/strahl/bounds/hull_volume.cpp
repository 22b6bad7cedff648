#include <algorithm>
#include <cmath>

#include <strahl/bounds/convex_hull.h>
#include <strahl/bounds/hull_volume.h>
#include <strahl/bounds/obb_fit.h>

namespace strahl {
namespace {

constexpr std::size_t kMostCandidates = 400, kFewPlanes = 12;
/// A corner that sticks out by less, relative to the size, is left alone.
constexpr double kNotWorthCutting = 1e-4;

/// Normals of a set without volume: of its plane, and of its outline in it.
std::vector<Vec3d> flat_normals(const std::vector<Vec3d>& points) {
  const Basis basis(principal_axes(points)[2]);
  std::vector<Vec2d> flat;
  flat.reserve(points.size());
  for (const Vec3d& p : points) flat.push_back({dot(basis.u, p), dot(basis.v, p)});
  const std::vector<Vec2d> outline = convex_polygon(std::move(flat));
  std::vector<Vec3d> normals{basis.w, -basis.w};
  for (std::size_t i = 0; i < outline.size() && outline.size() > 1; ++i) {
    const Vec2d &a = outline[i], &b = outline[(i + 1) % outline.size()];
    normals.push_back(unit((b.y - a.y) * basis.u - (b.x - a.x) * basis.v));
  }
  if (outline.size() == 2) {  // the ends of a line
    const Vec2d &a = outline[0], &b = outline[1];
    const Vec3d along = unit((b.x - a.x) * basis.u + (b.y - a.y) * basis.v);
    normals.push_back(along), normals.push_back(-along);
  }
  return normals;
}

/// Normals worth cutting along, from the points of a cloud.
std::vector<Vec3d> candidate_normals(const FitCloud& cloud) {
  FitCloud surface = cloud;
  if (!cloud.balls.empty() || cloud.faces.empty()) {
    surface.points = cloud.surface_points();
    const std::optional<ConvexHull> hull = convex_hull(surface.points);
    surface.faces = hull ? hull->triangles : std::vector<std::array<std::uint32_t, 3>>();
  }
  std::vector<Vec3d> normals = face_normals(surface, kMostCandidates);
  return normals.empty() ? flat_normals(surface.points) : normals;
}

/// Which of the candidates to keep, by the depth of what each cuts off. In the cloud's units.
std::vector<Vec3d> deepest_cuts(const FitCloud& cloud, const std::vector<Vec3d>& candidates,
                                std::size_t most) {
  std::vector<double> offset;
  offset.reserve(candidates.size());
  for (const Vec3d& n : candidates) offset.push_back(cloud.extent(n).second);
  const auto side = [&](int axis) {
    Vec3d n;
    n[axis] = 1.0;
    return cloud.extent(n);
  };
  const auto x = side(0), y = side(1), z = side(2);
  Polytope body({{x.first, y.first, z.first}, {x.second, y.second, z.second}});
  std::vector<Vec3d> kept;
  while (kept.size() < most) {
    double deepest = kNotWorthCutting;
    std::size_t best = candidates.size();
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const double reach = body.support(candidates[i]);
      if (reach - offset[i] > deepest) deepest = reach - offset[i], best = i;
    }
    if (best == candidates.size()) break;
    kept.push_back(candidates[best]);
    body.add(candidates[best], offset[best]);
  }
  return kept;
}

}  // namespace

HullVolume HullVolume::enclose(const EnclosedSet& set, FitEffort effort) {
  HullVolume v;
  v.box_ = AabbVolume::enclose(set);
  if (set.is_empty() || set.is_unbounded()) return v;
  const FitCloud cloud(set, true);
  const std::size_t most = effort == FitEffort::thorough ? kMostPlanes : kFewPlanes;
  const std::vector<Vec3d> normals = deepest_cuts(cloud, candidate_normals(cloud), most);
  v.planes_.reserve(normals.size());
  for (const Vec3d& n : normals) v.planes_.push_back(FacePlane::around(set, n));
  return v;
}

bool HullVolume::contains(const Vec3d& p) const {
  return box_.contains(p) && std::all_of(planes_.begin(), planes_.end(),
                                         [&](const FacePlane& f) { return f.contains(p); });
}

void HullVolume::add_planes_to(Polytope& body) const {
  for (const FacePlane& f : planes_) body.add(Vec3d(f.n), f.offset);
}

Polytope::Measure HullVolume::measure() const {
  if (box().is_empty()) return {};
  Polytope body(box());
  add_planes_to(body);
  return body.measure();
}

void HullVolume::add_corners_to(EnclosedSet& set) const {
  const Aabb b = box();
  if (b.is_empty()) return;
  if (!is_finite(b.lo) || !is_finite(b.hi)) return set.add(b);
  Polytope body(b, Polytope::Use::corners);
  add_planes_to(body);
  body.add_corners_to(set);
}

void HullVolume::add_sides_to(SideList& sides) const {
  sides.add(box());
  for (const FacePlane& f : planes_) sides.add(VolumeSide::plane(Vec3d(f.n), f.offset));
}

}  // namespace strahl
