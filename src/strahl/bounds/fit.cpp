#include <algorithm>
#include <cmath>

#include <strahl/bounds/convex_hull.h>
#include <strahl/bounds/fit.h>

namespace strahl {
namespace {

constexpr std::size_t kFewPoints = 48;  // up to here a hull costs more than it saves

/// One rotation that makes element (p, q) of the symmetric matrix zero.
void rotate(std::array<std::array<double, 3>, 3>& m, std::array<Vec3d, 3>& axes, std::size_t p,
            std::size_t q) {
  if (m[p][q] == 0.0) return;
  const double theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
  const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
  const double c = 1.0 / std::hypot(t, 1.0), s = t * c;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = m[k][p], b = m[k][q];
    m[k][p] = c * a - s * b, m[k][q] = s * a + c * b;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = m[p][k], b = m[q][k];
    m[p][k] = c * a - s * b, m[q][k] = s * a + c * b;
  }
  const Vec3d a = axes[p], b = axes[q];
  axes[p] = c * a - s * b, axes[q] = s * a + c * b;
}

/// rows += weight * p p^T
void add_outer(std::array<Vec3d, 3>& rows, const Vec3d& p, double weight) {
  for (std::size_t i = 0; i < 3; ++i) rows[i] = rows[i] + (weight * p[static_cast<int>(i)]) * p;
}

double power_of_two_above(double v) {
  int exponent = 0;
  std::frexp(v, &exponent);
  return std::ldexp(1.0, exponent);
}

}  // namespace

Basis::Basis(const Vec3d& axis) : w(unit(axis)) {
  const Vec3d a = abs(w);
  const Vec3d least = a.x <= a.y && a.x <= a.z ? Vec3d{1, 0, 0}
                      : a.y <= a.z             ? Vec3d{0, 1, 0}
                                               : Vec3d{0, 0, 1};
  u = unit(cross(least, w));
  v = cross(w, u);
}

FitCloud::FitCloud(const EnclosedSet& set, bool with_faces) {
  if (set.is_empty()) return;
  Aabb box = set.box();
  for (const Vec3d& p : set.points()) box.extend(p);
  center = box.center();
  const double size = norm_max(box.extent());
  scale = size > 0.0 ? power_of_two_above(size) : 1.0;
  for (const Vec3d& p : set.points()) points.push_back(to_own(p));
  for (const Ball& b : set.balls()) balls.push_back({to_own(b.center), b.radius / scale});
  if (!with_faces && points.size() <= kFewPoints) return;
  const std::optional<ConvexHull> hull = convex_hull(points);
  if (!hull) return;
  std::vector<Vec3d> extreme;
  std::vector<std::uint32_t> number(points.size());
  for (const std::uint32_t v : hull->vertices) {
    number[v] = static_cast<std::uint32_t>(extreme.size());
    extreme.push_back(points[v]);
  }
  faces = hull->triangles;
  for (auto& face : faces)
    for (std::uint32_t& v : face) v = number[v];
  points = std::move(extreme);
}

std::vector<Vec3d> FitCloud::surface_points() const {
  std::vector<Vec3d> all = points;
  for (const Ball& b : balls) {
    for (std::size_t i = 0; i < 7; ++i) {
      const Vec3d reach = b.radius * dop_directions()[i];
      all.push_back(b.center + reach), all.push_back(b.center - reach);
    }
  }
  return all;
}

std::pair<double, double> FitCloud::extent(const Vec3d& n) const {
  double lo = Aabb::kInf, hi = -Aabb::kInf;
  const auto offer = [&](double at, double reach) {
    lo = std::min(lo, at - reach), hi = std::max(hi, at + reach);
  };
  for (const Vec3d& p : points) offer(dot(n, p), 0.0);
  for (const Ball& b : balls) offer(dot(n, b.center), b.radius);
  return {lo, hi};
}

std::array<Vec3d, 3> eigenvectors(std::array<Vec3d, 3> rows) {
  std::array<std::array<double, 3>, 3> m;
  for (std::size_t i = 0; i < 3; ++i) m[i] = {rows[i].x, rows[i].y, rows[i].z};
  std::array<Vec3d, 3> axes{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  for (int sweep = 0; sweep < 10; ++sweep)
    rotate(m, axes, 0, 1), rotate(m, axes, 0, 2), rotate(m, axes, 1, 2);
  std::array<std::size_t, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return m[a][a] > m[b][b]; });
  return {axes[order[0]], axes[order[1]], axes[order[2]]};
}

std::array<Vec3d, 3> principal_axes(std::span<const Vec3d> points) {
  Vec3d mean;
  for (const Vec3d& p : points) mean = mean + p;
  mean = mean / static_cast<double>(points.size());
  std::array<Vec3d, 3> covariance;
  for (const Vec3d& p : points) add_outer(covariance, p - mean, 1.0);
  return eigenvectors(covariance);
}

std::array<Vec3d, 3> principal_axes(std::span<const Vec3d> points,
                                    std::span<const std::array<std::uint32_t, 3>> faces) {
  std::array<Vec3d, 3> second;
  Vec3d first;
  double total = 0.0;
  for (const auto& [a, b, c] : faces) {
    const Vec3d p = points[a], q = points[b], r = points[c];
    const Vec3d middle = (p + q + r) / 3.0;
    const double area = length(cross(q - p, r - p));
    total += area, first = first + area * middle;
    add_outer(second, middle, 9.0 * area / 12.0);
    for (const Vec3d& v : {p, q, r}) add_outer(second, v, area / 12.0);
  }
  if (!(total > 0.0)) return principal_axes(points);
  add_outer(second, first, -1.0 / total);
  return eigenvectors(second);
}

const std::array<Vec3d, 13>& dop_directions() {
  static const std::array<Vec3d, 13> kDirections = [] {
    std::array<Vec3d, 13> d{Vec3d{1, 0, 0}, {0, 1, 0},  {0, 0, 1}, {1, 1, 1}, {1, 1, -1},
                            {1, -1, 1},     {-1, 1, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1},
                            {1, -1, 0},     {1, 0, -1}, {0, 1, -1}};
    for (Vec3d& n : d) n = normalized(n);
    return d;
  }();
  return kDirections;
}

Vec3d longest_direction(std::span<const Vec3d> points) {
  if (points.empty()) return {1, 0, 0};
  Vec3d from = points[0], to = points[0];
  for (int pass = 0; pass < 3; ++pass) {
    from = to;
    for (const Vec3d& p : points)
      if (dot(p - from, p - from) > dot(to - from, to - from)) to = p;
  }
  return to == from ? Vec3d{1, 0, 0} : unit(to - from);
}

std::vector<Vec3d> axis_candidates(const FitCloud& cloud, FitEffort effort) {
  const std::vector<Vec3d> points = cloud.surface_points();
  std::vector<Vec3d> axes;
  for (const Vec3d& a : principal_axes(points, cloud.faces)) axes.push_back(a);
  axes.push_back(longest_direction(points));
  const std::size_t directions = effort == FitEffort::fast ? 3 : 13;
  axes.insert(axes.end(), dop_directions().begin(),
              dop_directions().begin() + static_cast<std::ptrdiff_t>(directions));
  if (effort == FitEffort::thorough || cloud.points.size() <= 12) {
    if (cloud.points.size() >= 3) {
      const Vec3d n = cross(points[1] - points[0], points[2] - points[0]);
      if (norm_max(n) > 0.0) axes.push_back(unit(n));
    }
  }
  return axes;
}

}  // namespace strahl
