#include <bit>
#include <cmath>
#include <cstdint>
#include <initializer_list>

#include <strahl/geometry/edge_signs.h>
#include <strahl/geometry/exact_vec.h>
#include <strahl/geometry/integer_edges.h>

namespace strahl {
namespace {

int sign(double v) { return (v > 0.0) - (v < 0.0); }

int first_nonzero(std::initializer_list<int> signs) {
  for (int s : signs)
    if (s != 0) return s;
  return 0;
}

/// Perturbation terms after dir . n = 0 and n = 0: those of org, then of both.
int sign_on_edge_line(const Vec3d& dir, const Vec3d& p, const Vec3d& q) {
  const auto c = difference(q, p);
  const auto m = exact_cross(exact(dir), c);
  return first_nonzero({m.x.sign(), m.y.sign(), m.z.sign(), -c.z.sign(), c.y.sign(), -c.x.sign()});
}

/// Whether no component has more than so many significant bits.
template <int kBits>
bool is_short(const Vec3d& v) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  constexpr std::uint64_t kRest = (std::uint64_t{1} << (53 - kBits)) - 1;
  return ((bits(v.x) | bits(v.y) | bits(v.z)) & kRest) == 0;
}

/// Whether difference, a - b rounded, is a - b. Of the two below, that with the larger of a and b
/// is exact [Dekker1971].
bool is_exact(double difference, double a, double b) {
  return (difference + b == a) & (a - difference == b);
}

/// Whether dir x P is 0, P = point - org. Sure when true: the products are exact for directions of
/// 24 bits and P of 29, as float32 coordinates give them.
bool passes_exactly(const Vec3d& dir, const Vec3d& org, const Vec3d& point, const Vec3d& P) {
  const bool is_along =
      (dir.y * P.z == dir.z * P.y) & (dir.z * P.x == dir.x * P.z) & (dir.x * P.y == dir.y * P.x);
  if (!is_along) return false;
  return is_short<24>(dir) & is_short<29>(P) & is_exact(P.x, point.x, org.x) &
         is_exact(P.y, point.y, org.y) & is_exact(P.z, point.z, org.z);
}

/// The sign of the first component of P x Q = P x along that is not 0, along = Q - P; 0 where
/// rounding leaves it uncertain. Edges along an axis have components that are certainly 0.
int certain_normal_sign(const Vec3d& P, const Vec3d& along) {
  for (int x = 0; x < 3; ++x) {
    const int y = x == 2 ? 0 : x + 1, z = 3 - x - y;
    const double a = P[y] * along[z], b = P[z] * along[y];
    // Differences, products and their difference: four roundings at most, none of zeros.
    if (a == 0.0 && b == 0.0) continue;
    return std::abs(a - b) > 8 * 0x1p-53 * (std::abs(a) + std::abs(b)) ? sign(a - b) : 0;
  }
  return 0;
}

}  // namespace

int exact_edge_sign(const Vec3d& org, const Vec3d& dir, const Vec3d& p, const Vec3d& q) {
  const auto n = exact_cross(difference(p, org), difference(q, org));
  const int first =
      first_nonzero({exact_dot(n, exact(dir)).sign(), n.x.sign(), n.y.sign(), n.z.sign()});
  return first != 0 ? first : sign_on_edge_line(dir, p, q);
}

EdgeSigns::EdgeSigns(const ExactRay& ray, const TriangleVertices& tri, const Vec3d& e)
    : ray_(ray), tri_(tri), to_{tri.a - ray.org, tri.b - ray.org, tri.c - ray.org} {
  const double per_reach = 16 * 0x1p-53 * norm1(ray.dir);
  const double reach[] = {norm_max(to_[0]), norm_max(to_[1]), norm_max(to_[2])};
  const double values[] = {e.x, e.z, e.y};
  for (std::size_t i = 0; i < 3; ++i) {
    const double bound = std::min(ray.edge_error, per_reach * (reach[i] * reach[next(i)]));
    sign_[i] = std::abs(values[i]) > bound ? sign(values[i]) : 0;
  }
}

std::optional<int> EdgeSigns::common() {
  if (has(0) && !differ()) find_at_corner();
  if (has(0) && !differ()) find_by_integers();
  for (std::size_t i = 0; i < 3 && !differ(); ++i)
    if (sign_[i] == 0) sign_[i] = exact_edge_sign(ray_.org, ray_.dir, corner(i), corner(next(i)));
  if (differ() || has(0)) return std::nullopt;
  return sign_[0];
}

/// Rays aimed at vertices: the two edges there have e = 0, and their next terms are certain.
void EdgeSigns::find_at_corner() {
  for (std::size_t known = 0; known < 3; ++known) {
    const std::size_t from = next(known), at = next(from);  // the edges from -> at -> known
    if (sign_[known] == 0 || sign_[from] != 0 || sign_[at] != 0) continue;
    if (!passes_exactly(ray_.dir, ray_.org, corner(at), to_[at])) return;
    sign_[from] = certain_normal_sign(to_[from], corner(at) - corner(from));
    if (!differ()) sign_[at] = certain_normal_sign(to_[at], corner(known) - corner(at));
    return;
  }
}

void EdgeSigns::find_by_integers() {
  const auto integers = IntegerEdges::make(ray_.org, ray_.dir, tri_);
  if (!integers) return;
  if (sign_[0] == 0) sign_[0] = integers->ab();
  if (sign_[1] == 0) sign_[1] = integers->bc();
  if (sign_[2] == 0) sign_[2] = integers->ca();
}

}  // namespace strahl
