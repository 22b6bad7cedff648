#include <algorithm>
#include <array>

#include <strahl/geometry/edge_signs.h>
#include <strahl/geometry/exact_vec.h>
#include <strahl/geometry/triangle.h>
#include <strahl/math/coordinate.h>
#include <strahl/math/double_double.h>

namespace strahl {
namespace {

ExactVec<16> exact_normal(const TriangleVertices& tri) {
  return exact_cross(difference(tri.b, tri.a), difference(tri.c, tri.a));
}

/// numerator / denominator when both are certain to 2^-42, else empty.
std::optional<double> certified_quotient(double numerator, double numerator_bound,
                                         double denominator, double denominator_bound) {
  if (!(std::abs(numerator) > 0x1p42 * numerator_bound)) return std::nullopt;
  if (!(std::abs(denominator) > 0x1p42 * denominator_bound)) return std::nullopt;
  return numerator / denominator;
}

/// A triple product rounded once: in double-double when that decides the rounding, else exactly.
/// @param bound of the sum of the magnitudes of the six monomials
template <class Wide, class Exact>
double rounded_once(double bound, Wide wide_value, Exact exact_value) {
  if (const auto value = certain_rounding(wide_value(), 0x1p-98 * bound)) return *value;
  return rounded(exact_value());
}

double rounded_denominator(const Vec3d& dir, const TriangleVertices& tri) {
  const double bound = 2 * norm_max(tri.b - tri.a) * norm_max(tri.c - tri.a) * norm1(dir);
  return rounded_once(
      bound,
      [&] {
        return dot(cross(wide_difference(tri.b, tri.a), wide_difference(tri.c, tri.a)), wide(dir));
      },
      [&] { return exact_dot(exact_normal(tri), exact(dir)); });
}

double rounded_numerator(const Vec3d& org, const TriangleVertices& tri) {
  const double bound = 2 * norm_max(tri.b - tri.a) * norm_max(tri.c - tri.a) * norm1(tri.a - org);
  return rounded_once(
      bound,
      [&] {
        return dot(cross(wide_difference(tri.b, tri.a), wide_difference(tri.c, tri.a)),
                   wide_difference(tri.a, org));
      },
      [&] { return exact_dot(exact_normal(tri), difference(tri.a, org)); });
}

double rounded_edge(const Vec3d& org, const Vec3d& dir, const Vec3d& p, const Vec3d& q) {
  const double bound = 2 * norm_max(p - org) * norm_max(q - p) * norm1(dir);
  return rounded_once(
      bound, [&] { return dot(cross(wide_difference(p, org), wide_difference(q, p)), wide(dir)); },
      [&] { return exact_dot(exact_cross(difference(p, org), difference(q, p)), exact(dir)); });
}

/// A power of two that brings the largest coordinate to about the largest one allowed.
double scale_up(const Vec3d& org, const TriangleVertices& tri) {
  const double most = std::max({norm_max(org), norm_max(tri.a), norm_max(tri.b), norm_max(tri.c)});
  return std::ldexp(1.0, std::ilogb(kMaxCoordinate) - 1 - std::ilogb(most));
}

/// Weight of the corner opposite to edge (p, q) for a ray in the plane: n . N / N . N. Products of
/// four coordinates would underflow where all are tiny, so they are scaled first, which is exact
/// and changes no quotient.
double in_plane_weight(const Vec3d& org, const TriangleVertices& tri, const Vec3d& p,
                       const Vec3d& q) {
  const double s = scale_up(org, tri);
  const auto n = exact_cross(difference(s * p, s * org), difference(s * q, s * org));
  const auto normal = exact_normal({s * tri.a, s * tri.b, s * tri.c});
  return rounded(exact_dot(n, normal)) / rounded(exact_dot(normal, normal));
}

/// Weight of the corner opposite to edge (p, q): certified double, else rounded once each. The edge
/// value is dir . (P x (q - p)): the same as dir . (P x Q), without its cancellation.
double weight(const Vec3d& org, const Vec3d& dir, const TriangleVertices& tri, const Vec3d& p,
              const Vec3d& q) {
  constexpr double kUnit = 0x1p-53;
  const Vec3d P = p - org, pq = q - p, ab = tri.b - tri.a, ac = tri.c - tri.a;
  const double spread = 2 * norm1(dir);
  const std::optional<double> w =
      certified_quotient(dot(cross(dir, P), pq), 8 * kUnit * spread * norm_max(P) * norm_max(pq),
                         dot(dir, cross(ab, ac)), 9 * kUnit * spread * norm_max(ab) * norm_max(ac));
  if (w) return *w + 0.0;
  const double denominator = rounded_denominator(dir, tri);
  if (denominator == 0.0) return in_plane_weight(org, tri, p, q) + 0.0;
  return rounded_edge(org, dir, p, q) / denominator + 0.0;
}

/// Unit normal; components exact and rounded once where cancellation threatens.
Vec3d unit_normal(const TriangleVertices& tri) {
  const Vec3d ab = tri.b - tri.a, ac = tri.c - tri.a;
  Vec3d n = cross(ab, ac);
  if (!(norm_max(n) > 0x1p-11 * norm_max(ab) * norm_max(ac))) {
    const auto e = exact_normal(tri);
    n = {rounded(e.x), rounded(e.y), rounded(e.z)};
  }
  return unit(n) + Vec3d{};  // no -0
}

/// Exact orientation of (p, q, r) after dropping `axis`.
int orientation_2d(const Vec3d& p, const Vec3d& q, const Vec3d& r, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  return (exact_difference(q[u], p[u]) * exact_difference(r[v], p[v]) -
          exact_difference(q[v], p[v]) * exact_difference(r[u], p[u]))
      .sign();
}

/// A nearly convex polygon. Rounding may bend it, so a cut can replace each outside corner by two:
/// 3 corners become at most 4, 6, 9, 13, 19, 28 in six cuts.
struct Polygon {
  std::array<Vec3d, 28> corner;
  std::size_t count = 0;
};

/// Part of the polygon with side * x[axis] <= side * plane ([SutherlandHodgman1974]).
Polygon cut(const Polygon& in, int axis, double plane, double side) {
  Polygon out;
  for (std::size_t i = 0; i < in.count; ++i) {
    const Vec3d &p = in.corner[i], &q = in.corner[i + 1 == in.count ? 0 : i + 1];
    const double dp = side * (p[axis] - plane), dq = side * (q[axis] - plane);
    if (dp <= 0) out.corner[out.count++] = p;
    if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
      Vec3d x = p + (q - p) * (dp / (dp - dq));
      x[axis] = plane;
      out.corner[out.count++] = x;
    }
  }
  return out;
}

}  // namespace

std::optional<TriangleHit> intersect_uncertain(const ExactRay& ray, const TriangleVertices& tri,
                                               const Vec3d& edge_values) {
  const std::optional<int> side = EdgeSigns(ray, tri, edge_values).common();
  if (!side) return std::nullopt;
  const std::optional<double> t = crossing_t(ray.org, ray.dir, tri, tri.a - ray.org);
  if (!t) return std::nullopt;
  return TriangleHit{*t + 0.0, *side < 0};  // -0 + 0 is +0
}

std::optional<double> exact_t(const Vec3d& org, const Vec3d& dir, const TriangleVertices& tri) {
  const double denominator = rounded_denominator(dir, tri);
  const double numerator = rounded_numerator(org, tri);
  if (denominator == 0.0) {
    // Three agreeing signs with dir . N = 0: the origin lies on the triangle, in its plane.
    if (numerator != 0.0) return std::nullopt;
    return 0.0;
  }
  const double t = numerator / denominator;
  if (!std::isfinite(t)) return std::nullopt;
  return t;
}

TriangleSurface surface_at(const Vec3d& org, const Vec3d& dir, const TriangleVertices& tri) {
  return {weight(org, dir, tri, tri.c, tri.a), weight(org, dir, tri, tri.a, tri.b),
          unit_normal(tri)};
}

bool is_on_triangle(const Vec3d& point, const TriangleVertices& tri) {
  if (!tri.bounds().contains(point)) return false;
  const auto n = exact_normal(tri);
  if (exact_dot(n, difference(tri.a, point)).sign() != 0) return false;
  const int axis = n.x.sign() != 0 ? 0 : n.y.sign() != 0 ? 1 : 2;
  const int s0 = orientation_2d(tri.a, tri.b, point, axis);
  const int s1 = orientation_2d(tri.b, tri.c, point, axis);
  const int s2 = orientation_2d(tri.c, tri.a, point, axis);
  return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

TriangleDefect find_defect(const TriangleVertices& tri) {
  if (!is_finite(tri.a) || !is_finite(tri.b) || !is_finite(tri.c))
    return TriangleDefect::not_finite;
  if (tri.a == tri.b || tri.b == tri.c || tri.c == tri.a) return TriangleDefect::repeated_vertex;
  const Vec3d ab = tri.b - tri.a, ac = tri.c - tri.a;
  // gamma(4) * 2 |ab| |ac| bounds the error of each component of the rounded normal.
  if (norm_max(cross(ab, ac)) > 16 * 0x1p-53 * norm_max(ab) * norm_max(ac))
    return TriangleDefect::none;
  const auto n = exact_normal(tri);
  const bool is_zero = n.x.sign() == 0 && n.y.sign() == 0 && n.z.sign() == 0;
  return is_zero ? TriangleDefect::zero_area : TriangleDefect::none;
}

Aabb clip(const TriangleVertices& tri, const Aabb& box) {
  const Aabb whole = Aabb::intersection(tri.bounds(), box);
  if (whole.is_empty() || whole == tri.bounds()) return whole;
  // A computed corner is off by at most 8 u times the largest coordinate per cut, six cuts: cut
  // at planes moved outward by twice that, then widen the result by it.
  const Aabb own = tri.bounds();
  const double slack = 96 * 0x1p-53 * std::max(norm_max(own.lo), norm_max(own.hi));
  Polygon polygon{{tri.a, tri.b, tri.c}, 3};
  for (int axis = 0; axis < 3; ++axis) {
    if (own.hi[axis] > box.hi[axis]) polygon = cut(polygon, axis, box.hi[axis] + slack, 1.0);
    if (own.lo[axis] < box.lo[axis]) polygon = cut(polygon, axis, box.lo[axis] - slack, -1.0);
  }
  Aabb part;
  for (std::size_t i = 0; i < polygon.count; ++i) part.extend(polygon.corner[i]);
  if (polygon.count == 0) return {};
  part.lo = part.lo - Vec3d::all(slack), part.hi = part.hi + Vec3d::all(slack);
  return Aabb::intersection(part, whole);
}

}  // namespace strahl
