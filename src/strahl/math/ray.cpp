#include <algorithm>
#include <cmath>

#include <strahl/math/coordinate.h>
#include <strahl/math/ray.h>

namespace strahl {

bool is_valid(const Ray& ray) {
  return is_coordinate(ray.org) && is_coordinate(ray.dir) && norm_max(ray.dir) > 0.0 &&
         ray.t_min >= 0.0 && std::isfinite(ray.t_min) && ray.t_max >= 0.0;
}

PreparedRay::PreparedRay(const Ray& ray, const RayFrame& frame)
    : ExactRay(ray.org, ray.dir, frame.bounds), t_min(ray.t_min), t_max(ray.t_max) {
  const double widen = frame.widen_absolute + frame.widen_per_org * norm_max(org);
  for (int axis = 0; axis < 3; ++axis) {
    negative[axis] = dir[axis] < 0.0;
    inv_dir[axis] = dir[axis] == 0.0 ? Aabb::kInf : 1.0 / dir[axis];
    near_org[axis] = negative[axis] ? org[axis] - widen : org[axis] + widen;
    far_org[axis] = negative[axis] ? org[axis] + widen : org[axis] - widen;
  }
  t_enter = lowered(t_min, kHitMargin);
  t_exit = std::min(raised(t_max, kHitMargin), std::numeric_limits<double>::max());
}

}  // namespace strahl
