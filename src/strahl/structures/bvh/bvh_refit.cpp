#include <algorithm>
#include <vector>

#include <strahl/structures/bvh/bvh_refit.h>

namespace strahl {
namespace {

constexpr std::size_t kGrain = 4096;

std::vector<Aabb> bound_all(const PrimitiveSource& source, const BuildContext& context) {
  context.require_memory(std::uint64_t{source.size()} * sizeof(Aabb), "boxes of moved primitives");
  std::vector<Aabb> boxes(source.size());
  context.executor.parallel_for(0, boxes.size(), kGrain, [&](std::size_t from, std::size_t to) {
    context.check(0.0, "fitting");
    for (std::size_t i = from; i < to; ++i) boxes[i] = source.bounds(static_cast<std::uint32_t>(i));
  });
  return boxes;
}

bool are_empty(const Aabb& box) { return box.is_empty(); }

}  // namespace

std::size_t count_things(const Hierarchy& hierarchy, std::uint32_t size) {
  std::vector<bool> is_known(size);
  for (const std::uint32_t reference : hierarchy.references) is_known[reference] = true;
  return static_cast<std::size_t>(std::count(is_known.begin(), is_known.end(), true));
}

std::optional<Hierarchy> fit_hierarchy(Hierarchy hierarchy, const PrimitiveSource& source,
                                       const BuildContext& context) {
  const std::vector<Aabb> boxes = bound_all(source, context);
  const auto empty = static_cast<std::size_t>(std::count_if(boxes.begin(), boxes.end(), are_empty));
  if (count_things(hierarchy, source.size()) + empty != boxes.size()) return std::nullopt;
  for (std::size_t i = hierarchy.nodes.size(); i-- > 0;) {
    HierarchyNode& node = hierarchy.nodes[i];
    for (std::uint32_t k = 0; k < node.count; ++k) {
      const Aabb& box = boxes[hierarchy.references[node.first + k]];
      if (box.is_empty()) return std::nullopt;
      node.box.extend(box);
    }
    for (const HierarchyNode& child : hierarchy.children(node)) node.box.extend(child.box);
  }
  return hierarchy;
}

}  // namespace strahl
