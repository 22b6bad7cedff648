#include <algorithm>
#include <cmath>
#include <vector>

#include <strahl/bounds/prism_volume.h>

namespace strahl {
namespace {

constexpr double kSharpCosine = -0.985;  // of the angle between the normals at a corner

/// A line n.x = offset along an edge.
struct Edge {
  Vec2d n;
  double offset;
};

double dot2(const Vec2d& a, const Vec2d& b) { return a.x * b.x + a.y * b.y; }
double cross2(const Vec2d& a, const Vec2d& b) { return a.x * b.y - a.y * b.x; }

Edge edge_between(const Vec2d& a, const Vec2d& b) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  const Vec2d n{(b.y - a.y) / length, -(b.x - a.x) / length};
  return {n, dot2(n, a)};
}

Vec2d meeting_point(const Edge& a, const Edge& b) {
  const double d = cross2(a.n, b.n);
  return {(a.offset * b.n.y - b.offset * a.n.y) / d, (b.offset * a.n.x - a.offset * b.n.x) / d};
}

/// What leaving out edge i adds to the area; infinite where its neighbours do not meet beyond it.
double cost_of_dropping(const std::vector<Edge>& edges, std::size_t i) {
  const std::size_t n = edges.size();
  const Edge &before = edges[(i + n - 1) % n], &own = edges[i], &after = edges[(i + 1) % n];
  if (!(cross2(before.n, after.n) > 1e-3)) return Aabb::kInf;
  const Vec2d tip = meeting_point(before, after), a = meeting_point(before, own),
              b = meeting_point(own, after);
  return 0.5 * std::abs(cross2({b.x - a.x, b.y - a.y}, {tip.x - a.x, tip.y - a.y}));
}

/// A square end at each corner too sharp for rounded normals.
std::vector<Vec2d> with_square_ends(const std::vector<Edge>& edges) {
  std::vector<Vec2d> normals;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Vec2d &a = edges[i].n, &b = edges[(i + 1) % edges.size()].n;
    normals.push_back(a);
    if (dot2(a, b) > kSharpCosine) continue;
    // Half way around from a to b.
    const double turn = 0.5 * std::atan2(cross2(a, b), dot2(a, b));
    const double c = std::cos(turn), s = std::sin(turn);
    normals.push_back({c * a.x - s * a.y, s * a.x + c * a.y});
  }
  return normals;
}

std::vector<Vec2d> rectangle_normals(const std::vector<Vec2d>& polygon) {
  Vec2d along{1, 0};
  if (polygon.size() == 2) along = edge_between(polygon[0], polygon[1]).n;
  return {along, {-along.y, along.x}, {-along.x, -along.y}, {along.y, -along.x}};
}

/// Outline of a cloud across an axis.
std::vector<Vec2d> outline(const std::vector<Vec3d>& points, const Basis& basis) {
  std::vector<Vec2d> flat;
  flat.reserve(points.size());
  for (const Vec3d& p : points) flat.push_back({dot(basis.u, p), dot(basis.v, p)});
  return convex_polygon(std::move(flat));
}

/// Half the surface of the prism over the whole outline.
double prism_cost(const std::vector<Vec2d>& polygon, double height) {
  double area = 0.0, perimeter = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    area += 0.5 * cross2(a, b);
    perimeter += std::hypot(b.x - a.x, b.y - a.y);
  }
  return area + 0.5 * perimeter * height;
}

}  // namespace

std::vector<Vec2d> reduced_normals(const std::vector<Vec2d>& polygon, std::size_t most) {
  if (polygon.size() < 3) return rectangle_normals(polygon);
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    edges.push_back(edge_between(polygon[i], polygon[(i + 1) % polygon.size()]));
  while (edges.size() > most - 2) {  // at most two corners can be sharp
    std::size_t best = 0;
    double least = Aabb::kInf;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const double cost = cost_of_dropping(edges, i);
      if (cost < least) least = cost, best = i;
    }
    if (least == Aabb::kInf) return rectangle_normals({});
    edges.erase(edges.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return with_square_ends(edges);
}

PrismVolume PrismVolume::enclose(const EnclosedSet& set, FitEffort effort) {
  PrismVolume v;
  if (set.is_unbounded()) {
    v.ends_.hi = std::numeric_limits<float>::infinity(), v.ends_.lo = -v.ends_.hi;
    return v;
  }
  if (set.is_empty()) return v;
  const FitCloud cloud(set);
  const std::vector<Vec3d> points = cloud.surface_points();
  const auto cost = [&](const Vec3d& axis) {
    const auto [lo, hi] = cloud.extent(axis);
    return prism_cost(outline(points, Basis(axis)), hi - lo);
  };
  const Basis basis(best_axis(axis_candidates(cloud, effort), effort, cost).axis);
  v.ends_ = Slab::around(set, basis.w);
  for (const Vec2d& n : reduced_normals(outline(points, basis), kMostSides))
    v.side_[v.sides_++] = FacePlane::around(set, n.x * basis.u + n.y * basis.v);
  return v;
}

bool PrismVolume::contains(const Vec3d& p) const {
  return ends_.contains(p) && std::all_of(side_.begin(), side_.begin() + sides_,
                                          [&](const FacePlane& f) { return f.contains(p); });
}

void PrismVolume::add_planes_to(Polytope& body) const {
  body.add(Vec3d(ends_.n), ends_.hi), body.add(-Vec3d(ends_.n), -double{ends_.lo});
  for (std::uint32_t i = 0; i < sides_; ++i) body.add(Vec3d(side_[i].n), side_[i].offset);
}

Polytope::Measure PrismVolume::measure() const {
  if (is_empty()) return {};
  Polytope body(box());
  add_planes_to(body);
  return body.measure();
}

/// Neighbouring sides meet in lines of known direction; the ends cut them to corners. Each corner
/// solves three planes moved out, which covers the rounding: no corner is sharp.
void PrismVolume::add_corners_to(EnclosedSet& set) const {
  if (is_empty()) return;
  double reach = std::max(std::abs(double{ends_.lo}), std::abs(double{ends_.hi}));
  for (std::uint32_t i = 0; i < sides_; ++i)
    reach = std::max(reach, std::abs(double{side_[i].offset}));
  if (sides_ == 0) return set.add_corner(Vec3d::all(Aabb::kInf));
  const double margin = kCornerMargin * reach;
  const Vec3d w(ends_.n);
  for (std::uint32_t i = 0; i < sides_; ++i) {
    const FacePlane &f = side_[i], &g = side_[(i + 1) % sides_];
    const Vec3d a(f.n), b(g.n);
    const Vec3d da = cross(b, w), db = cross(w, a), dw = cross(a, b);
    const double determinant = dot(a, da);
    const Vec3d sides = (f.offset + margin) * da + (g.offset + margin) * db;
    for (const double end : {ends_.lo - margin, ends_.hi + margin})
      set.add_corner((sides + end * dw) / determinant);
  }
}

Aabb PrismVolume::box() const {
  EnclosedSet corners;
  add_corners_to(corners);
  if (corners.is_unbounded()) return {Vec3d::all(-Aabb::kInf), Vec3d::all(Aabb::kInf)};
  return corners.box();
}

void PrismVolume::add_sides_to(SideList& sides) const {
  sides.add_slab(Vec3d(ends_.n), ends_.lo, ends_.hi);
  for (std::uint32_t i = 0; i < sides_; ++i)
    sides.add(VolumeSide::plane(Vec3d(side_[i].n), side_[i].offset));
}

}  // namespace strahl
