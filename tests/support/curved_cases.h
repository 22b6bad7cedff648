// tests/support/curved_cases.h - what tests of spheres and cones share: high precision, random
// rays.
#pragma once

#include <cmath>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <strahl/base/rng.h>
#include <strahl/geometry/curved.h>

namespace strahl::test {

/// 100 decimal digits: sums and products of a few doubles of similar size are exact.
using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_100::backend_type,
                                           boost::multiprecision::et_off>;
using WideVec = Vec3<Wide>;

inline WideVec wide(const Vec3d& v) { return {Wide(v.x), Wide(v.y), Wide(v.z)}; }
inline double narrow(const Wide& v) { return v.convert_to<double>(); }

/// A root in high precision.
struct WideRoot {
  Wide t;
  bool is_front;
};

inline Vec3d random_vector(Rng& rng, double reach = 1.0) {
  return {rng.uniform(-reach, reach), rng.uniform(-reach, reach), rng.uniform(-reach, reach)};
}
/// Magnitudes spread evenly over the exponents from 10^low to 10^high.
inline double random_magnitude(Rng& rng, double low, double high) {
  return std::pow(10.0, rng.uniform(low, high));
}

/// A ray that passes near `target` from about `distance` away, with |dir| anywhere in 2^-20..2^20;
/// one in four is parallel to a coordinate plane, one in eight to an axis.
inline Ray random_ray_at(Rng& rng, const Vec3d& target, double distance) {
  Vec3d dir = unit(random_vector(rng));
  const std::uint32_t kind = rng.below(8);
  if (kind <= 1) dir[static_cast<int>(rng.below(3))] = 0.0;
  if (kind == 2) {
    const int axis = static_cast<int>(rng.below(3));
    dir = {};
    dir[axis] = rng.below(2) == 0 ? 1.0 : -1.0;
  }
  Ray ray;
  ray.org = target - distance * dir;
  ray.dir = std::ldexp(1.0, static_cast<int>(rng.below(41)) - 20) * rng.uniform(1.0, 2.0) * dir;
  return ray;
}

/// The box, or one that encloses it: equal, one ulp larger, a little or much larger on each side.
inline Aabb random_enclosing_box(Rng& rng, const Aabb& box) {
  Aabb outer = box;
  const auto grow = [&](double v, double sign) {
    switch (rng.below(4)) {
      case 0:
        return v;
      case 1:
        return std::nextafter(v, sign * Aabb::kInf);
      case 2:
        return v + sign * std::abs(v) * rng.uniform();
      default:
        return v + sign * random_magnitude(rng, -10, 30);
    }
  };
  for (int axis = 0; axis < 3; ++axis) {
    outer.lo[axis] = grow(box.lo[axis], -1.0);
    outer.hi[axis] = grow(box.hi[axis], 1.0);
  }
  return outer;
}

/// Whether the conservative filter, on a ray from t = 0, keeps all of [first, last] cut at 0.
inline bool filter_keeps(const Ray& ray, const Aabb& box, double first, double last) {
  if (last < 0.0) return true;
  const Interval kept = clip_to_box(PreparedRay(ray, RayFrame{}), box.lo, box.hi,
                                    {0.0, std::numeric_limits<double>::max()});
  return kept.t_enter <= std::max(first, 0.0) && kept.t_exit >= last;
}

/// Whether both say the same: number of roots, sides, and t within tolerance * max(|t|, unit).
inline bool agree(const CurvedHits& hits, const std::vector<WideRoot>& truth, double unit_t,
                  double tolerance) {
  if (static_cast<std::size_t>(hits.count) != truth.size()) return false;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (hits.hit[i].is_front != truth[i].is_front) return false;
    const double error = std::abs(narrow(Wide(hits.hit[i].t) - truth[i].t));
    if (!(error <= tolerance * std::max(std::abs(hits.hit[i].t), unit_t))) return false;
  }
  return true;
}

}  // namespace strahl::test
