#include <algorithm>
#include <cmath>
#include <numbers>

#include <strahl/geometry/surface_piece.h>

namespace strahl {
namespace {

/// Patches across a box or the surface, whichever is smaller, where they are cut.
constexpr double kFineness = 8.0;
/// Parts of the whole of which each is taken to be stretched evenly by an instance.
constexpr double kStretchParts = 16.0;

constexpr double kPi = std::numbers::pi;

/// Unit vectors, the last along the axis.
std::array<Vec3d, 3> axes_around(const Vec3d& axis) {
  const Vec3d w = unit(axis), size = abs(w);
  const int least = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
  Vec3d other;
  other[least] = 1.0;
  const Vec3d u = unit(cross(w, other));
  return {u, cross(w, u), w};
}

enum class Place { outside, across, inside };

/// Where a ball is. NaN planes cut nothing.
Place place_of(const Vec3d& center, double radius, const Aabb& box) {
  Place place = Place::inside;
  for (int axis = 0; axis < 3; ++axis) {
    const double x = center[axis];
    if (x + radius < box.lo[axis] || x - radius > box.hi[axis]) return Place::outside;
    if (x - radius < box.lo[axis] || x + radius > box.hi[axis]) place = Place::across;
  }
  return place;
}

}  // namespace

FlatPiece::FlatPiece(const TriangleVertices& triangle)
    : corner_{triangle.a, triangle.b, triangle.c} {}

void FlatPiece::cut_to(const Aabb& box) {
  for (int axis = 0; axis < 3; ++axis) {
    cut(axis, box.hi[axis], 1.0);
    cut(axis, box.lo[axis], -1.0);
  }
}

double FlatPiece::area() const {
  Vec3d doubled{0, 0, 0};
  for (std::size_t i = 2; i < count_; ++i)
    doubled = doubled + cross(corner_[i - 1] - corner_[0], corner_[i] - corner_[0]);
  return 0.5 * length(doubled);
}

/// Keeps side * x[axis] <= side * plane.
void FlatPiece::cut(int axis, double plane, double side) {
  const auto depth = [&](const Vec3d& p) { return side * (plane - p[axis]); };
  const auto is_out = [&](const Vec3d& p) { return depth(p) < 0.0; };
  const std::size_t n = count_;
  if (std::none_of(corner_.begin(), corner_.begin() + static_cast<std::ptrdiff_t>(n), is_out))
    return;
  const std::array<Vec3d, 10> from = corner_;
  count_ = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d &p = from[i], &q = from[(i + 1) % n];
    const double dp = depth(p), dq = depth(q);
    if (!is_out(p) && count_ < corner_.size()) corner_[count_++] = p;
    if (is_out(p) == is_out(q) || count_ == corner_.size()) continue;
    corner_[count_] = p + (dp / (dp - dq)) * (q - p);
    corner_[count_++][axis] = plane;
  }
}

CurvedSurface::CurvedSurface(const Sphere& sphere, const Affine& to_world)
    : is_sphere_(true),
      origin_(sphere.center),
      axes_{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
      radius_(sphere.radius),
      top_radius_(sphere.radius),
      to_world_(to_world),
      is_placed_(!to_world.is_identity()) {
  finish();
}

CurvedSurface::CurvedSurface(const Cone& cone, const Affine& to_world)
    : is_sphere_(false),
      origin_(cone.base),
      axes_(axes_around(cone.apex - cone.base)),
      radius_(cone.base_radius),
      top_radius_(cone.apex_radius),
      height_(length(cone.apex - cone.base)),
      slant_(std::hypot(height_, top_radius_ - radius_)),
      to_world_(to_world),
      is_placed_(!to_world.is_identity()) {
  finish();
}

/// Nothing is divided that is small against the whole or near the roundings of its place.
void CurvedSurface::finish() {
  if (is_placed_) longest_stretch_ = longest_stretch(to_world_);
  const Vec3d at = middle(whole());
  least_reach_ = std::max(0x1p-20 * reach(whole()), 0x1p-40 * norm_max(at));
  width_ = 2.0 * longest_stretch_ * std::max(radius_, top_radius_);
}

double CurvedSurface::fine_reach(double extent) const {
  return std::max(std::min(extent, width_) / kFineness, least_reach_);
}

Patch CurvedSurface::whole() const { return {0.0, is_sphere_ ? kPi : 1.0, 0.0, 2.0 * kPi}; }

std::array<Patch, 2> CurvedSurface::halves(const Patch& p) const {
  const auto [along_u, along_v] = lengths(p);
  if (along_u > along_v) {
    const double u = 0.5 * (p.u0 + p.u1);
    return {{{p.u0, u, p.v0, p.v1}, {u, p.u1, p.v0, p.v1}}};
  }
  const double v = 0.5 * (p.v0 + p.v1);
  return {{{p.u0, p.u1, p.v0, v}, {p.u0, p.u1, v, p.v1}}};
}

Vec3d CurvedSurface::point(double u, double v) const {
  const double along = is_sphere_ ? radius_ * std::cos(u) : height_ * u;
  const Vec3d around = std::cos(v) * axes_[0] + std::sin(v) * axes_[1];
  const Vec3d at = origin_ + radius_at(u) * around + along * axes_[2];
  return is_placed_ ? to_world_.point(at) : at;
}

/// From the middle along the circle, then along the profile.
double CurvedSurface::reach(const Patch& p) const {
  const auto [along_u, along_v] = lengths(p);
  return 0.5 * longest_stretch_ * (along_u + along_v);
}

double CurvedSurface::area(const Patch& p) const {
  if (!is_placed_) return object_area(p);
  const Patch all = whole();
  if (reach(p) * kStretchParts > reach(all)) {
    const auto [first, second] = halves(p);
    return area(first) + area(second);
  }
  return object_area(p) * stretch_at(0.5 * (p.u0 + p.u1), 0.5 * (p.v0 + p.v1));
}

std::array<TriangleVertices, 2> CurvedSurface::flattened(const Patch& p) const {
  std::array<Vec3d, 4> corner{point(p.u0, p.v0), point(p.u1, p.v0), point(p.u1, p.v1),
                              point(p.u0, p.v1)};
  const Vec3d mean = 0.25 * ((corner[0] + corner[2]) + (corner[1] + corner[3]));
  for (Vec3d& c : corner) c = c + (2.0 / 3.0) * (middle(p) - mean);
  return {{{corner[0], corner[1], corner[2]}, {corner[0], corner[3], corner[2]}}};
}

double CurvedSurface::share_inside(const Patch& p, const Aabb& box) const {
  double whole = 0.0, inside = 0.0;
  for (const TriangleVertices& triangle : flattened(p)) {
    FlatPiece half(triangle);
    whole += half.area();
    half.cut_to(box);
    inside += half.area();
  }
  return whole > 0.0 ? inside / whole : 0.0;
}

double CurvedSurface::radius_at(double u) const {
  return is_sphere_ ? radius_ * std::sin(u) : radius_ + u * (top_radius_ - radius_);
}

double CurvedSurface::largest_radius(const Patch& p) const {
  if (is_sphere_ && p.u0 < 0.5 * kPi && p.u1 > 0.5 * kPi) return radius_;
  return std::max(radius_at(p.u0), radius_at(p.u1));
}

std::array<double, 2> CurvedSurface::lengths(const Patch& p) const {
  return {(is_sphere_ ? radius_ : slant_) * (p.u1 - p.u0), largest_radius(p) * (p.v1 - p.v0)};
}

double CurvedSurface::object_area(const Patch& p) const {
  const double angle = p.v1 - p.v0;
  if (is_sphere_) return radius_ * radius_ * (std::cos(p.u0) - std::cos(p.u1)) * angle;
  return slant_ * (p.u1 - p.u0) * radius_at(0.5 * (p.u0 + p.u1)) * angle;
}

/// Area in the world over area in object space, from the images of two unit tangents.
double CurvedSurface::stretch_at(double u, double v) const {
  const double out = is_sphere_ ? std::cos(u) : (top_radius_ - radius_) / slant_;
  const double up = is_sphere_ ? -std::sin(u) : height_ / slant_;
  const Vec3d around = std::cos(v) * axes_[0] + std::sin(v) * axes_[1];
  const Vec3d across = std::cos(v) * axes_[1] - std::sin(v) * axes_[0];
  const Vec3d along = out * around + up * axes_[2];
  return length(cross(to_world_.vector(along), to_world_.vector(across)));
}

void CurvedPiece::cut_to(const Aabb& box) {
  const double fine = surface_->fine_reach(norm_max(box.extent()));
  std::vector<Patch> waiting = std::move(patches_);
  patches_.clear(), area_ = 0.0;
  while (!waiting.empty()) {
    const Patch patch = waiting.back();
    waiting.pop_back();
    const double reach = surface_->reach(patch);
    const Place place = place_of(surface_->middle(patch), reach, box);
    if (place == Place::outside) continue;
    if (place == Place::across && reach > fine) {
      for (const Patch& half : surface_->halves(patch)) waiting.push_back(half);
      continue;
    }
    const double share = place == Place::inside ? 1.0 : surface_->share_inside(patch, box);
    if (share == 0.0) continue;
    patches_.push_back(patch);
    area_ += share * surface_->area(patch);
  }
}

}  // namespace strahl
