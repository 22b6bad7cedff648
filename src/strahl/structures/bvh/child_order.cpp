#include <algorithm>
#include <numeric>
#include <span>

#include <strahl/structures/bvh/child_order.h>

namespace strahl {

ChildOrder order_children(Hierarchy& hierarchy) {
  const std::vector<HierarchyNode> before = hierarchy.nodes;
  ChildOrder order{std::vector<std::uint8_t>(before.size(), 0),
                   std::vector<std::uint32_t>(before.size())};
  std::iota(order.from.begin(), order.from.end(), 0u);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const HierarchyNode node = hierarchy.nodes[i];
    if (node.is_leaf()) continue;
    // Siblings are moved as they are: what lies below is found by their own links.
    const std::span children = std::span(order.from).subspan(node.first, node.children);
    Aabb centers;
    for (const std::uint32_t child : children) centers.extend(before[child].box.center());
    const int axis = centers.longest_axis();
    const auto at = [&](std::uint32_t child) { return before[child].box.center()[axis]; };
    std::stable_sort(children.begin(), children.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return at(a) < at(b); });
    for (std::size_t k = 0; k < children.size(); ++k)
      hierarchy.nodes[node.first + k] = before[children[k]];
    order.axes[i] = static_cast<std::uint8_t>(axis);
  }
  return order;
}

}  // namespace strahl
