#include <cmath>

#include <strahl/query/scene_visitor.h>

namespace strahl {
namespace {

double flushed(double v) { return std::abs(v) < 0x1p-240 ? 0.0 : v; }
Vec3d flushed(const Vec3d& v) { return {flushed(v.x), flushed(v.y), flushed(v.z)}; }

}  // namespace

std::optional<Ray> to_object_space(const Ray& ray, const Affine& to_object) {
  const Ray object{flushed(to_object.point(ray.org)), flushed(to_object.vector(ray.dir)), ray.t_min,
                   ray.t_max};
  // Below 2^-180 flushing would no longer be far below the widening of world boxes.
  if (!is_valid(object) || norm_max(object.dir) < 0x1p-180) return std::nullopt;
  return object;
}

void SceneVisitor::enter_instance(std::uint32_t instance, const PreparedRay& world_ray) {
  cached_instance_ = instance;
  object_ray_.reset();
  const Ray world{world_ray.org, world_ray.dir, world_ray.t_min, world_ray.t_max};
  if (const auto object = to_object_space(world, scene_.to_object()[instance]))
    object_ray_.emplace(*object, scene_.object_frame(instance));
}

}  // namespace strahl
