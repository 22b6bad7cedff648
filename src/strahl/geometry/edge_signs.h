// geometry/edge_signs.h - exact signs of a triangle's edges as a ray passes them, for the exact
// test of triangle.h.
//
// The rule and its filter: triangle.h. The sign is that of the first of these terms that is not 0,
//   where n = P x Q = P x (Q - P):
//     dir . n;  n.x, n.y, n.z;  dir x (Q - P): x, y, z;  P - Q: z, -y, x
//   the first when dir and org are as given, the others by the perturbation of org.
// Thread safety: values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include <strahl/geometry/mesh.h>
#include <strahl/math/ray.h>

namespace strahl {

/// Exact sign (+1 or -1) of the directed edge (p, q) as the perturbed ray passes it; 0 if p == q.
int exact_edge_sign(const Vec3d& org, const Vec3d& dir, const Vec3d& p, const Vec3d& q);

/// Signs of the edges of a triangle, each found by the cheapest means that is certain. Edge i runs
/// from corner i to the next: ab, bc, ca.
class EdgeSigns {
 public:
  /// @param e filtered values of ab, ca, bc
  EdgeSigns(const ExactRay& ray, const TriangleVertices& tri, const Vec3d& e);

  /// The sign that all share, if they do.
  std::optional<int> common();

 private:
  static std::size_t next(std::size_t i) { return i == 2 ? 0 : i + 1; }
  const Vec3d& corner(std::size_t i) const { return i == 0 ? tri_.a : i == 1 ? tri_.b : tri_.c; }
  bool has(int s) const { return sign_[0] == s || sign_[1] == s || sign_[2] == s; }
  bool differ() const { return has(1) && has(-1); }

  void find_at_corner();
  void find_by_integers();

  const ExactRay& ray_;
  const TriangleVertices& tri_;
  Vec3d to_[3];  ///< corners from the origin
  int sign_[3];  ///< 0 as long as it is not known
};

}  // namespace strahl
