#include <map>
#include <utility>

#include <strahl/geometry/instance_source.h>

namespace strahl {

InstanceSource::InstanceSource(const Scene& scene) : scene_(scene) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
  for (std::uint32_t i = 0; i < size(); ++i) {
    const Instance& inst = scene.instances()[i];
    const auto next = static_cast<std::uint32_t>(objects_.size());
    const auto [entry, is_new] =
        known.try_emplace({inst.first_geometry, inst.geometry_count}, next);
    if (is_new) objects_.push_back(i);
    object_of_.push_back(entry->second);
  }
}

Aabb InstanceSource::bounds(std::uint32_t instance) const {
  const Aabb& own = scene_.object_frame(instance).bounds;
  if (own.is_empty() || scene_.is_identity(instance)) return own;
  return transformed(scene_.instances()[instance].to_world, own);
}

}  // namespace strahl
