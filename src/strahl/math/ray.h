// math/ray.h - a ray as given, and the same ray prepared for traversal.
//
// The prepared form carries what every filter needs once per ray: reciprocal direction, origins
// shifted by the scene's widening (see geometry/scene.h, 0 without instances) and the constant
// error bound of the edge-sign filter (see geometry/triangle.h).
#pragma once

#include <limits>

#include <strahl/math/aabb.h>
#include <strahl/math/margin.h>
#include <strahl/math/vec3.h>

namespace strahl {

/// org + t*dir for t in [t_min, t_max] (closed). dir need not be unit length; t is in units of
/// |dir|.
struct Ray {
  Vec3d org, dir;
  double t_min = 0.0;
  double t_max = std::numeric_limits<double>::infinity();
};

/// True unless org or dir hold NaN or infinity or a magnitude outside 0, 2^-240..2^240 (2^-149 for
/// floats is inside), dir is zero, t_min is negative, NaN or infinite, or t_max is negative or NaN.
/// t_min > t_max is valid and hits nothing.
bool is_valid(const Ray& ray);

/// What makes a prepared ray fit its scene. Widening: |shift of a hit| <= absolute + per_org*|org|.
struct RayFrame {
  Aabb bounds;                  ///< of everything exact tests are made against, untransformed
  double widen_absolute = 0.0;  ///< in scene units
  double widen_per_org = 0.0;   ///< per unit of the origin's largest coordinate
};

/// What the exact test of triangles needs of a ray.
struct ExactRay {
  Vec3d org, dir;
  double edge_error;  ///< an edge value beyond it has a certain sign

  ExactRay() = default;
  /// @param bounds of all vertices that it will be tested with
  ExactRay(const Vec3d& o, const Vec3d& d, const Aabb& bounds) : org(o), dir(d) {
    // 16 u |dir|_1 M^2, M >= |vertex - org| for every vertex: see geometry/triangle.h.
    const double reach = norm_max(max(abs(bounds.lo - org), abs(bounds.hi - org)));
    edge_error = 16 * 0x1p-53 * norm1(dir) * reach * reach;
  }
};

/// A ray with its per-ray constants. Axis a's near plane is hit first: box.hi where dir[a] < 0.
struct PreparedRay : ExactRay {
  Vec3d inv_dir;            ///< 1/dir; +inf where dir is 0 or -0
  Vec3d near_org, far_org;  ///< org moved so that near planes come earlier, far planes later
  double t_min, t_max;      ///< as given
  double t_enter, t_exit;   ///< [t_min, t_max] widened by kHitMargin, t_exit finite
  bool negative[3];         ///< dir[a] < 0

  PreparedRay() = default;
  PreparedRay(const Ray& ray, const RayFrame& frame);

  /// Earliest and latest parameter at which the ray may reach plane x[axis] = p. NaN where the ray
  /// runs inside the plane (dir 0, org on it): comparisons must be written so that NaN means "may".
  double plane_first(int axis, double p) const { return (p - near_org[axis]) * inv_dir[axis]; }
  double plane_last(int axis, double p) const { return (p - far_org[axis]) * inv_dir[axis]; }
};

/// A parameter interval; empty when t_enter > t_exit.
struct Interval {
  double t_enter, t_exit;
};

/// Conservative slab test: the part of [in.t_enter, in.t_exit] in which the ray may be inside box.
/// Empty results mean a certain miss; NaNs of rays inside a plane do not cut anything.
inline Interval clip_to_box(const PreparedRay& ray, const Vec3d& lo, const Vec3d& hi, Interval in) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool neg = ray.negative[axis];
    const double first = ray.plane_first(axis, neg ? hi[axis] : lo[axis]);
    const double last = ray.plane_last(axis, neg ? lo[axis] : hi[axis]) * (1.0 + 2 * kPlaneMargin);
    in.t_enter = first > in.t_enter ? first : in.t_enter;
    in.t_exit = last < in.t_exit ? last : in.t_exit;
  }
  return in;
}

/// Conservative half-space test: the part of `in` in which the ray may be where x[axis] <= plane,
/// or x[axis] >= plane if is_above. The margins are those of clip_to_box(), plane by plane, so
/// tests of several half-spaces may follow each other.
inline Interval clip_to_side(const PreparedRay& ray, int axis, bool is_above, double plane,
                             Interval in) {
  if (is_above != ray.negative[axis]) {
    const double first = ray.plane_first(axis, plane);
    in.t_enter = first > in.t_enter ? first : in.t_enter;
  } else {
    const double last = ray.plane_last(axis, plane) * (1.0 + 2 * kPlaneMargin);
    in.t_exit = last < in.t_exit ? last : in.t_exit;
  }
  return in;
}

}  // namespace strahl
