#include <algorithm>
#include <cmath>

#include <strahl/bounds/bound_margin.h>
#include <strahl/bounds/fit.h>
#include <strahl/bounds/polytope.h>

namespace strahl {
namespace {

/// Opposite planes of a flat body touch up to rounding, relative to the size.
constexpr double kTouching = 1e-13;
/// Planes closer than this are one.
constexpr double kSame = 1e-12;

/// Leaves the part of a polygon where n.x <= offset.
void cut(std::vector<Vec3d>& polygon, const Vec3d& n, double offset, std::vector<Vec3d>& spare) {
  spare.clear();
  double before = polygon.empty() ? 0.0 : dot(n, polygon.back()) - offset;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const double here = dot(n, polygon[i]) - offset;
    if ((before < 0.0 && here > 0.0) || (before > 0.0 && here < 0.0)) {
      const Vec3d& a = polygon[i == 0 ? polygon.size() - 1 : i - 1];
      spare.push_back(a + (before / (before - here)) * (polygon[i] - a));
    }
    if (here <= 0.0) spare.push_back(polygon[i]);
    before = here;
  }
  polygon.swap(spare);
}

Vec3d area_vector(const std::vector<Vec3d>& polygon) {
  Vec3d sum;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum = sum + cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return 0.5 * sum;
}

}  // namespace

Polytope::Polytope(const Aabb& box, Use use)
    : center_(box.center()), size_(norm_max(box.extent())) {
  margin_ = use == Use::corners
                ? kCornerMargin * size_ + kSupportMargin * (norm_max(center_) + size_)
                : 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d n;
    n[axis] = 1.0;
    add(n, box.hi[axis]), add(-n, -box.lo[axis]);
  }
}

void Polytope::add(const Vec3d& n, double offset) {
  const double norm = length(n);
  Face face{n / norm, (offset - dot(n, center_)) / norm + margin_, {}};
  for (const Face& other : faces_)
    if (std::abs(face.offset - other.offset) < kSame * size_ && norm_max(face.n - other.n) < kSame)
      return;
  const Basis basis(face.n);
  const Vec3d middle = face.offset * face.n;
  const Vec3d u = (4.0 * size_ + std::abs(face.offset)) * basis.u,
              v = (4.0 * size_ + std::abs(face.offset)) * basis.v;
  face.polygon = {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
  const double touching = kTouching * size_;
  for (Face& other : faces_) {
    cut(face.polygon, other.n, other.offset + touching, spare_);
    cut(other.polygon, face.n, face.offset + touching, spare_);
  }
  faces_.push_back(std::move(face));
}

Polytope::Measure Polytope::measure() const {
  Measure sum;
  for (const Face& face : faces_) {
    const double area = length(area_vector(face.polygon));
    sum.half_area += 0.5 * area;
    sum.volume += face.offset * area / 3.0;
  }
  return sum;
}

void Polytope::add_corners_to(EnclosedSet& set) const {
  for (const Face& face : faces_)
    for (const Vec3d& p : face.polygon) set.add_corner(p + center_);
}

double Polytope::support(const Vec3d& n) const {
  double most = -Aabb::kInf;
  for (const Face& face : faces_)
    for (const Vec3d& p : face.polygon) most = std::max(most, dot(n, p));
  return most + dot(n, center_);
}

}  // namespace strahl
