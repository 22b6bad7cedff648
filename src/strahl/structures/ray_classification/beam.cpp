#include <algorithm>
#include <cmath>

#include <strahl/structures/ray_classification/beam.h>

namespace strahl {
namespace {

Vec3d axis_vector(int axis, double length) {
  Vec3d v;
  v[axis] = length;
  return v;
}

/// Least value of normal.x over a box.
double least(const Vec3d& normal, const Vec3d& lo, const Vec3d& hi) {
  double sum = 0.0;
  for (int a = 0; a < 3; ++a) sum += normal[a] * (normal[a] < 0.0 ? hi : lo)[a];
  return sum;
}

Vec3d normal_of(std::span<const StoredBall> corners) {
  const Vec3d a = corners[0].center();
  return cross(corners[1].center() - a, corners[2].center() - a);
}

}  // namespace

Beam::Beam(const RayCell& cell, int face)
    : center_(0.5 * (Vec3d{cell.lo[0], cell.lo[1], cell.lo[2]} +
                     Vec3d{cell.hi[0], cell.hi[1], cell.hi[2]})),
      half_(0.5 * (Vec3d{cell.hi[0], cell.hi[1], cell.hi[2]} -
                   Vec3d{cell.lo[0], cell.lo[1], cell.lo[2]})) {
  const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double forward = face % 2 == 0 ? 1.0 : -1.0;
  for (std::size_t i = 0; i < 4; ++i) {
    corner_[i][axis] = forward;
    corner_[i][u] = (i & 1 ? cell.hi : cell.lo)[3];
    corner_[i][v] = (i & 2 ? cell.hi : cell.lo)[4];
  }
  add_side(axis_vector(axis, -forward));
  for (std::size_t k = 0; k < 2; ++k) {
    const int across = k == 0 ? u : v;
    const double low = cell.lo[3 + k], high = cell.hi[3 + k];
    breadth_ = std::max(breadth_, 2.0 * half_[across] + 0.5 * (high - low));
    if (low >= 0.0) add_side(axis_vector(across, -1.0));
    if (high <= 0.0) add_side(axis_vector(across, 1.0));
    add_side(axis_vector(across, -1.0) + axis_vector(axis, forward * low));
    add_side(axis_vector(across, 1.0) - axis_vector(axis, forward * high));
  }
}

bool Beam::holds_all(const Vec3d& normal) const {
  return std::all_of(corner_.begin(), corner_.end(),
                     [&](const Vec3d& w) { return dot(normal, w) <= 0.0; });
}

double Beam::limit_of(const Vec3d& normal) const {
  return dot(normal, center_) + dot(abs(normal), half_) + kBeamSlack * norm1(normal);
}

void Beam::add_side(const Vec3d& normal) {
  sides_[side_count_++] = {normal, limit_of(normal), length(normal)};
}

bool Beam::may_meet(const Vec3d& lo, const Vec3d& hi) const {
  for (std::size_t i = 0; i < side_count_; ++i)
    if (least(sides_[i].normal, lo, hi) > sides_[i].limit) return false;
  return true;
}

bool Beam::may_meet_hull(std::span<const StoredBall> balls) const {
  for (std::size_t i = 0; i < side_count_; ++i) {
    const HalfSpace& side = sides_[i];
    const bool is_out = std::all_of(balls.begin(), balls.end(), [&](const StoredBall& ball) {
      return dot(side.normal, ball.center()) - side.length * ball.radius > side.limit;
    });
    if (is_out) return false;
  }
  return true;
}

/// 1 or -1 when all rays of the cell pass the edge on that side, else 0.
int Beam::side_of_edge(const Vec3d& a, const Vec3d& b) const {
  const Vec3d edge = b - a, to_a = a - center_;
  bool all_above = true, all_below = true;
  for (const Vec3d& w : corner_) {
    const Vec3d q = cross(edge, w);
    const double middle = dot(to_a, q);
    const double spread = dot(abs(q), half_) + kBeamSlack * norm1(q);
    all_above &= middle > spread;
    all_below &= middle < -spread;
  }
  return all_above ? 1 : all_below ? -1 : 0;
}

bool Beam::may_meet_triangle(std::span<const StoredBall> corners) const {
  if (!may_meet_hull(corners)) return false;
  const Vec3d a = corners[0].center(), b = corners[1].center(), c = corners[2].center();
  for (const Vec3d& n : {normal_of(corners), -normal_of(corners)})
    if (holds_all(n) && std::min({dot(n, a), dot(n, b), dot(n, c)}) > limit_of(n)) return false;
  const int ab = side_of_edge(a, b), bc = side_of_edge(b, c), ca = side_of_edge(c, a);
  return std::max({ab, bc, ca}) - std::min({ab, bc, ca}) < 2;
}

bool Beam::may_see_front(std::span<const StoredBall> corners) const {
  const Vec3d a = corners[0].center();
  const double ab = norm_max(corners[1].center() - a), ac = norm_max(corners[2].center() - a);
  const double off = 6.0 * kBeamSlack * (ab + ac + kBeamSlack) + 0x1p-15 * ab * ac;
  const Vec3d n = normal_of(corners);
  return !std::all_of(corner_.begin(), corner_.end(),
                      [&](const Vec3d& w) { return dot(n, w) > off; });
}

}  // namespace strahl
