// geometry/triangle.h - the exact ray-triangle test that every structure shares.
//
// Rule (docs/semantics.md): a line crosses the triangle when the signs of its three directed edges
//   agree; the sign of edge (p, q) is that of e = dir . (P x Q), P = p - org, Q = q - org, with
//   zero resolved by a symbolic perturbation of dir and org (simulation of simplicity
//   [Edelsbrunner1990]).
// Filter: e is evaluated as (dir x P) . Q. Each of its six monomials d_i P_j Q_k carries at most
//   seven roundings (P, Q, product, difference, product, two sums), so with M >= |P|, |Q| the error
//   is below gamma(7) * 2 |dir|_1 M^2 < 16 u |dir|_1 M^2 = ExactRay::edge_error. A larger |e|
//   has a certain sign. Else the bound is sharpened to this edge; then, where the ray passes
//   exactly through an end, e is 0 and the next terms are doubles (edge_signs.h); then integers of
//   128 bits are tried (integer_edges.h); else expansions decide.
// Parameter: t = (A . N) / (dir . N), N = (b - a) x (c - a). A . N and dir . N carry at most eight
//   roundings per monomial; when both exceed 2^42 times that bound their quotient is within
//   2^-41 + 2^-53 of the truth. Else both are computed exactly, rounded once, then divided.
// Thread safety: pure functions. Needs round-to-nearest (see base/fp_env.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <strahl/geometry/mesh.h>
#include <strahl/math/ray.h>

namespace strahl {

/// Canonical t from numerator and denominator computed exactly; empty when not finite.
std::optional<double> exact_t(const Vec3d& org, const Vec3d& dir, const TriangleVertices& tri);

/// A crossing: parameter and whether the front side was hit (common edge sign -1).
struct TriangleHit {
  double t;
  bool is_front;
};

/// Where a hit lies on its triangle: hit = (1 - u - v) a + u b + v c, unit vertex-order normal.
struct TriangleSurface {
  double u, v;
  Vec3d normal;
};

/// Barycentric coordinates and normal of a hit found by intersect(). Canonical, exact fallback.
TriangleSurface surface_at(const Vec3d& org, const Vec3d& dir, const TriangleVertices& tri);

/// True when the point lies on the closed triangle, decided exactly.
bool is_on_triangle(const Vec3d& point, const TriangleVertices& tri);

enum class TriangleDefect { none, not_finite, repeated_vertex, zero_area };

/// Why a triangle can never be hit, decided exactly.
TriangleDefect find_defect(const TriangleVertices& tri);

/// Conservative box of the part of the triangle inside box; empty only if that part is empty.
Aabb clip(const TriangleVertices& tri, const Aabb& box);

/// Canonical t of a triangle known to be crossed; empty when not finite.
/// @param A tri.a - org
inline std::optional<double> crossing_t(const Vec3d& org, const Vec3d& dir,
                                        const TriangleVertices& tri, const Vec3d& A) {
  const Vec3d ab = tri.b - tri.a, ac = tri.c - tri.a;
  const Vec3d n = cross(ab, ac);
  const double numerator = dot(A, n), denominator = dot(dir, n);
  // 2^42 * 9 u * 2 |ab| |ac|: what |numerator| / |A|_1 and |denominator| / |dir|_1 must exceed.
  const double needed = 18 * 0x1p-11 * norm_max(ab) * norm_max(ac);
  const bool numerator_is_certain = std::abs(numerator) > needed * norm1(A);
  const bool denominator_is_certain = std::abs(denominator) > needed * norm1(dir);
  if (numerator_is_certain & denominator_is_certain) return numerator / denominator;
  return exact_t(org, dir, tri);
}

/// intersect() where a sign of the three edge values (of ab, ca, bc) is uncertain.
std::optional<TriangleHit> intersect_uncertain(const ExactRay& ray, const TriangleVertices& tri,
                                               const Vec3d& edge_values);

/// The crossing of the ray's whole line with the triangle, if any; the caller checks the interval.
/// Without a branch per sign: signs are as good as random, and a mispredicted branch costs more
/// than the third edge of a triangle that the first two already rule out. The vertices must be
/// finite.
/// @param uncertain says what it is where a sign of the three edge values (of ab, ca, bc) is not
/// certain
template <class Uncertain>
std::optional<TriangleHit> intersect(const ExactRay& ray, const TriangleVertices& tri,
                                     Uncertain uncertain) {
  const Vec3d A = tri.a - ray.org, B = tri.b - ray.org, C = tri.c - ray.org;
  const Vec3d dir_a = cross(ray.dir, A);
  const Vec3d e{dot(dir_a, B), -dot(dir_a, C), dot(cross(ray.dir, B), C)};
  const double least = std::min(std::min(e.x, e.y), e.z), most = std::max(std::max(e.x, e.y), e.z);
  const bool is_back = least > ray.edge_error, is_front = most < -ray.edge_error;
  if (!(is_back | is_front)) {
    // Two certain signs that differ settle it whatever the third one is.
    const bool has_front = least < -ray.edge_error;
    const bool has_back = most > ray.edge_error;
    if (has_front & has_back) return std::nullopt;
    return uncertain(e);
  }
  const std::optional<double> t = crossing_t(ray.org, ray.dir, tri, A);
  if (!t) return std::nullopt;
  return TriangleHit{*t + 0.0, is_front};  // -0 + 0 is +0
}

inline std::optional<TriangleHit> intersect(const ExactRay& ray, const TriangleVertices& tri) {
  return intersect(ray, tri, [&](const Vec3d& e) { return intersect_uncertain(ray, tri, e); });
}

}  // namespace strahl
