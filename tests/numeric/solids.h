// tests/numeric/solids.h - closed solids with known insides, and the hit rule in 64-bit integers.
//
// Integer solids are small enough for every term of the rule to be an exact 64-bit integer, so the
// expected hits share nothing with the library but the rule.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include <strahl/geometry/mesh.h>

namespace strahl::test {

using Integers = std::array<std::int64_t, 3>;

inline Integers minus(const Integers& a, const Integers& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Integers cross_of(const Integers& a, const Integers& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline std::int64_t dot_of(const Integers& a, const Integers& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec3d as_vector(const Integers& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

struct IntegerTriangle {
  Integers a, b, c;
};
using IntegerMesh = std::vector<IntegerTriangle>;

/// The side on which the symbolically perturbed ray passes the directed edge (a, b), a != b.
inline int integer_edge_sign(const Integers& org, const Integers& dir, const Integers& a,
                             const Integers& b) {
  const Integers n = cross_of(minus(a, org), minus(b, org)), c = minus(b, a), m = cross_of(dir, c);
  for (const std::int64_t term :
       {dot_of(dir, n), n[0], n[1], n[2], m[0], m[1], m[2], -c[2], c[1], -c[0]})
    if (term != 0) return term > 0 ? 1 : -1;
  return 0;
}

struct IntegerHit {
  double t;  ///< one division of exact integers
  std::uint32_t triangle;
  bool is_front;
  auto operator<=>(const IntegerHit&) const = default;
};

/// Every triangle that the whole line crosses, sorted by t, then by number.
inline std::vector<IntegerHit> integer_crossings(const Integers& org, const Integers& dir,
                                                 const IntegerMesh& mesh) {
  std::vector<IntegerHit> found;
  for (std::uint32_t i = 0; i < mesh.size(); ++i) {
    const auto& [a, b, c] = mesh[i];
    const int ab = integer_edge_sign(org, dir, a, b);
    if (ab != integer_edge_sign(org, dir, b, c) || ab != integer_edge_sign(org, dir, c, a))
      continue;
    const Integers normal = cross_of(minus(b, a), minus(c, a));
    const auto along = static_cast<double>(dot_of(dir, normal));
    const auto offset = static_cast<double>(dot_of(minus(a, org), normal));
    found.push_back({along == 0.0 ? 0.0 : offset / along + 0.0, i, ab < 0});
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Closed surface of [-k, k]^3, every unit square split along one diagonal.
inline IntegerMesh integer_cube(std::int64_t k) {
  IntegerMesh mesh;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const std::int64_t side : {-k, k})
      for (std::int64_t u = -k; u < k; ++u)
        for (std::int64_t v = -k; v < k; ++v) {
          const auto corner = [&](std::int64_t x, std::int64_t y) {
            Integers p{};
            p[axis] = side, p[(axis + 1) % 3] = x, p[(axis + 2) % 3] = y;
            return p;
          };
          std::array q{corner(u, v), corner(u + 1, v), corner(u + 1, v + 1), corner(u, v + 1)};
          if (side < 0) std::reverse(q.begin(), q.end());
          mesh.push_back({q[0], q[1], q[2]}), mesh.push_back({q[0], q[2], q[3]});
        }
  return mesh;
}

/// Closed octahedron |x| + |y| + |z| = r.
inline IntegerMesh integer_octahedron(std::int64_t r) {
  IntegerMesh mesh;
  for (int octant = 0; octant < 8; ++octant) {
    const auto sign = [&](int bit) { return (octant >> bit & 1) == 0 ? r : -r; };
    const Integers a{sign(0), 0, 0}, b{0, sign(1), 0}, c{0, 0, sign(2)};
    const bool is_mirrored = sign(0) * sign(1) * sign(2) < 0;
    mesh.push_back(is_mirrored ? IntegerTriangle{a, c, b} : IntegerTriangle{a, b, c});
  }
  return mesh;
}

/// The same triangles in float32, each vertex stored once per triangle.
inline TriangleMesh as_mesh(const IntegerMesh& triangles) {
  std::vector<Vec3f> vertices;
  std::vector<std::uint32_t> indices;
  for (const IntegerTriangle& t : triangles)
    for (const Integers& p : {t.a, t.b, t.c}) {
      indices.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(Vec3f(as_vector(p)));
    }
  return make_mesh(std::move(vertices), std::move(indices));
}

/// Closed torus about the z axis, outward, of around * across quads.
inline TriangleMesh torus(double ring, double tube, std::uint32_t around, std::uint32_t across) {
  std::vector<Vec3f> vertices;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const double phi = 2 * std::numbers::pi * i / around;
      const double theta = 2 * std::numbers::pi * j / across;
      const double r = ring + tube * std::cos(theta);
      vertices.push_back(
          Vec3f(Vec3d{r * std::cos(phi), r * std::sin(phi), tube * std::sin(theta)}));
      const auto at = [&](std::uint32_t di, std::uint32_t dj) {
        return (i + di) % around * across + (j + dj) % across;
      };
      indices.insert(indices.end(), {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)});
    }
  return make_mesh(std::move(vertices), std::move(indices));
}

}  // namespace strahl::test
