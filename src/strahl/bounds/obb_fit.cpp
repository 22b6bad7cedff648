#include <algorithm>
#include <cmath>
#include <utility>

#include <strahl/bounds/convex_hull.h>
#include <strahl/bounds/obb_fit.h>

namespace strahl {
namespace {

constexpr std::size_t kMostFaces = 200;
constexpr std::size_t kStarts = 8;  // of small turns, from the best axes

/// A box across `axes[2]` and its cost.
struct Candidate {
  ObbAxes axes;
  double cost = Aabb::kInf;
};

struct Rectangle {
  double cosine = 1.0, sine = 0.0;
  double width = 0.0, height = 0.0;
};

Rectangle rectangle_along(const std::vector<Vec2d>& polygon, double c, double s) {
  double lo_x = Aabb::kInf, hi_x = -Aabb::kInf, lo_y = Aabb::kInf, hi_y = -Aabb::kInf;
  for (const Vec2d& p : polygon) {
    const double x = c * p.x + s * p.y, y = c * p.y - s * p.x;
    lo_x = std::min(lo_x, x), hi_x = std::max(hi_x, x);
    lo_y = std::min(lo_y, y), hi_y = std::max(hi_y, y);
  }
  return {c, s, hi_x - lo_x, hi_y - lo_y};
}

/// Tries the box with one axis given: the best rectangle across it.
class AxisSearch {
 public:
  AxisSearch(const std::vector<Vec3d>& points, ObbGoal goal) : points_(points), goal_(goal) {}

  /// Cost with this axis; best() remembers.
  double operator()(const Vec3d& axis) {
    const Basis basis(axis);
    std::vector<Vec2d> flat;
    flat.reserve(points_.size());
    double lo = Aabb::kInf, hi = -Aabb::kInf;
    for (const Vec3d& p : points_) {
      flat.push_back({dot(basis.u, p), dot(basis.v, p)});
      const double at = dot(basis.w, p);
      lo = std::min(lo, at), hi = std::max(hi, at);
    }
    const std::vector<Vec2d> polygon = convex_polygon(std::move(flat));
    double least = try_along(polygon, basis, hi - lo, 1.0, 0.0);
    for (std::size_t i = 0; i < polygon.size() && polygon.size() > 1; ++i) {
      const Vec2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double edge = std::hypot(b.x - a.x, b.y - a.y);
      least = std::min(least,
                       try_along(polygon, basis, hi - lo, (b.x - a.x) / edge, (b.y - a.y) / edge));
    }
    return least;
  }
  const Candidate& best() const { return best_; }

 private:
  double try_along(const std::vector<Vec2d>& polygon, const Basis& basis, double depth, double c,
                   double s) {
    const Rectangle r = rectangle_along(polygon, c, s);
    const double cost = box_cost({r.width, r.height, depth}, goal_);
    if (cost < best_.cost)
      best_ = {{c * basis.u + s * basis.v, c * basis.v - s * basis.u, basis.w}, cost};
    return cost;
  }

  const std::vector<Vec3d>& points_;
  ObbGoal goal_;
  Candidate best_;
};

}  // namespace

double box_cost(const Vec3d& w, ObbGoal goal) {
  const double half_area = w.x * w.y + w.y * w.z + w.z * w.x;
  // Among flat boxes the smaller area.
  return goal == ObbGoal::area ? half_area : w.x * w.y * w.z + 1e-6 * half_area;
}

std::vector<Vec3d> face_normals(const FitCloud& cloud, std::size_t most) {
  std::vector<Vec3d> sized;
  for (const auto& [a, b, c] : cloud.faces)
    sized.push_back(cross(cloud.points[b] - cloud.points[a], cloud.points[c] - cloud.points[a]));
  std::stable_sort(sized.begin(), sized.end(),
                   [](const Vec3d& a, const Vec3d& b) { return dot(a, a) > dot(b, b); });
  std::vector<Vec3d> normals;
  for (const Vec3d& n : sized) {
    if (normals.size() == most || !(norm_max(n) > 0.0)) break;
    const Vec3d u = unit(n);
    const auto is_near = [&](const Vec3d& other) { return dot(u, other) > 1.0 - 1e-9; };
    if (std::none_of(normals.begin(), normals.end(), is_near)) normals.push_back(u);
  }
  return normals;
}

ObbAxes covariance_axes(const FitCloud& cloud) {
  const std::vector<Vec3d> points = cloud.surface_points();
  if (points.empty()) return {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  if (cloud.balls.empty()) return principal_axes(points, cloud.faces);
  return principal_axes(points);
}

ObbAxes search_axes(const FitCloud& cloud, ObbGoal goal, FitEffort effort) {
  const std::vector<Vec3d> points = cloud.surface_points();
  AxisSearch search(points, goal);
  std::vector<Vec3d> candidates = axis_candidates(cloud, effort);
  if (effort == FitEffort::thorough)
    for (const Vec3d& n : face_normals(cloud, kMostFaces)) candidates.push_back(n);
  std::vector<std::pair<double, Vec3d>> tried;
  tried.reserve(candidates.size());
  for (const Vec3d& axis : candidates) tried.push_back({search(axis), axis});
  const auto cheaper = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::stable_sort(tried.begin(), tried.end(), cheaper);
  const std::size_t starts = effort == FitEffort::fast ? 0 : std::min(kStarts, tried.size());
  for (std::size_t i = 0; i < starts; ++i) best_axis({{tried[i].second}}, effort, search);
  for (double before = Aabb::kInf; search.best().cost < before * (1.0 - 1e-9);) {
    before = search.best().cost;
    for (const Vec3d& axis : ObbAxes(search.best().axes)) best_axis({{axis}}, effort, search);
    if (effort == FitEffort::fast) break;
  }
  return search.best().axes;
}

}  // namespace strahl
