#include <strahl/structures/bvh/volume_fit.h>

namespace strahl {

NodeContents::NodeContents(const PrimitiveSource& source, const Hierarchy& hierarchy)
    : source_(source), hierarchy_(hierarchy), below_(hierarchy.nodes.size(), 0) {
  for (std::size_t i = hierarchy.nodes.size(); i-- > 0;) {
    const HierarchyNode& node = hierarchy.nodes[i];
    below_[i] = node.count;
    for (std::uint32_t k = 0; k < node.children; ++k) below_[i] += below_[node.first + k];
  }
}

EnclosedSet NodeContents::of(std::uint32_t node) const {
  EnclosedSet set;
  if (below_[node] <= kMost)
    add_primitives(node, set);
  else
    add_boxes(node, set);
  return set;
}

void NodeContents::add_primitives(std::uint32_t node, EnclosedSet& set) const {
  std::vector<std::uint32_t> waiting{node};
  while (!waiting.empty()) {
    const HierarchyNode& at = hierarchy_.nodes[waiting.back()];
    waiting.pop_back();
    for (std::uint32_t k = 0; k < at.children; ++k) waiting.push_back(at.first + k);
    for (std::uint32_t k = 0; k < at.count; ++k) {
      const std::uint32_t reference = hierarchy_.references[at.first + k];
      if (at.box.contains(source_.bounds(reference)))
        set.add(source_, reference);
      else
        set.add(source_.clip(reference, at.box));
    }
  }
}

/// Those of the first nodes below, level by level, that do not lie inside each other.
void NodeContents::add_boxes(std::uint32_t node, EnclosedSet& set) const {
  std::vector<std::uint32_t> frontier{node};
  std::size_t next = 0;  // those before it are given up for their children
  while (next < frontier.size()) {
    const HierarchyNode& at = hierarchy_.nodes[frontier[next]];
    if (frontier.size() - next - 1 + at.children > kMost) break;
    ++next;
    if (at.is_leaf()) set.add(at.box);
    for (std::uint32_t k = 0; k < at.children; ++k) frontier.push_back(at.first + k);
  }
  for (; next < frontier.size(); ++next) set.add(hierarchy_.nodes[frontier[next]].box);
}

}  // namespace strahl
