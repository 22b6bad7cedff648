#include <cmath>

#include <strahl/math/coordinate.h>
#include <strahl/query/scene_visitor.h>

namespace strahl {
namespace {

double flushed(double v) { return std::abs(v) < kMinCoordinate ? 0.0 : v; }
Vec3d flushed(const Vec3d& v) { return {flushed(v.x), flushed(v.y), flushed(v.z)}; }

}  // namespace

std::optional<Ray> to_object_space(const Ray& ray, const Affine& to_object) {
  const Ray object{flushed(to_object.point(ray.org)), flushed(to_object.vector(ray.dir)), ray.t_min,
                   ray.t_max};
  // Below 2^-180 flushing would no longer be far below the widening of world boxes.
  if (!is_valid(object) || norm_max(object.dir) < 0x1p-180) return std::nullopt;
  return object;
}

std::optional<PreparedRay> enter_instance(const Scene& scene, std::uint32_t instance,
                                          const PreparedRay& world_ray) {
  const Ray world{world_ray.org, world_ray.dir, world_ray.t_min, world_ray.t_max};
  const std::optional<Ray> object = to_object_space(world, scene.to_object()[instance]);
  if (!object) return std::nullopt;
  return PreparedRay(*object, scene.object_frame(instance));
}

}  // namespace strahl
