#include <map>
#include <utility>

#include <strahl/geometry/instance_source.h>

namespace strahl {

InstanceSource::InstanceSource(const Scene& scene) : scene_(&scene) {
  const auto grouping = std::make_shared<Grouping>();
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
  for (std::uint32_t i = 0; i < size(); ++i) {
    const Instance& inst = scene.instances()[i];
    const auto next = static_cast<std::uint32_t>(grouping->objects.size());
    const auto [entry, is_new] =
        known.try_emplace({inst.first_geometry, inst.geometry_count}, next);
    if (is_new) grouping->objects.push_back(i);
    grouping->object_of.push_back(entry->second);
  }
  grouping_ = grouping;
}

std::uint64_t InstanceSource::bytes() const {
  return (grouping_->objects.capacity() + grouping_->object_of.capacity()) * sizeof(std::uint32_t);
}

}  // namespace strahl
