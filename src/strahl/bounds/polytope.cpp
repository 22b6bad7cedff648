#include <cmath>

#include <strahl/bounds/bound_margin.h>
#include <strahl/bounds/fit.h>
#include <strahl/bounds/polytope.h>

namespace strahl {
namespace {

/// The part of a polygon where n.x <= offset.
std::vector<Vec3d> cut(const std::vector<Vec3d>& polygon, const HalfSpace& h) {
  std::vector<Vec3d> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = dot(h.n, a) - h.offset, db = dot(h.n, b) - h.offset;
    if (da <= 0.0) kept.push_back(a);
    if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0))
      kept.push_back(a + (da / (da - db)) * (b - a));
  }
  return kept;
}

Vec3d area_vector(const std::vector<Vec3d>& polygon) {
  Vec3d sum;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum = sum + cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return 0.5 * sum;
}

}  // namespace

Polytope::Polytope(const Aabb& box) : center_(box.center()), size_(norm_max(box.extent())) {
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d n;
    n[axis] = 1.0;
    add(n, box.hi[axis]), add(-n, -box.lo[axis]);
  }
}

void Polytope::add(const Vec3d& n, double offset) {
  const double norm = length(n);
  planes_.push_back({n / norm, (offset - dot(n, center_)) / norm});
}

std::vector<Vec3d> Polytope::face(std::size_t i, double margin) const {
  const HalfSpace& own = planes_[i];
  const Basis basis(own.n);
  const Vec3d middle = (own.offset + margin) * own.n;
  const double reach = 4.0 * size_ + std::abs(own.offset);
  std::vector<Vec3d> polygon{
      middle - reach * basis.u - reach * basis.v, middle + reach * basis.u - reach * basis.v,
      middle + reach * basis.u + reach * basis.v, middle - reach * basis.u + reach * basis.v};
  for (std::size_t j = 0; j < planes_.size() && !polygon.empty(); ++j) {
    if (j == i) continue;
    const HalfSpace& other = planes_[j];
    // Two planes as good as one make one face, that of the first.
    const bool is_same = dot(own.n, other.n) > 0.0 && norm_max(own.n - other.n) < 1e-12;
    if (is_same && std::abs(own.offset - other.offset) < 1e-12 * size_) {
      if (j < i) return {};
      continue;
    }
    // Opposite planes of a flat body touch up to rounding.
    polygon = cut(polygon, {other.n, other.offset + margin + 1e-13 * size_});
  }
  return polygon;
}

Polytope::Measure Polytope::measure() const {
  Measure sum;
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const double area = length(area_vector(face(i, 0.0)));
    sum.half_area += 0.5 * area;
    sum.volume += planes_[i].offset * area / 3.0;
  }
  return sum;
}

void Polytope::add_corners_to(EnclosedSet& set) const {
  const double margin = kCornerMargin * size_ + kSupportMargin * norm_max(center_);
  for (std::size_t i = 0; i < planes_.size(); ++i)
    for (const Vec3d& p : face(i, margin)) set.add_corner(p + center_);
}

}  // namespace strahl
