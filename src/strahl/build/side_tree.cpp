#include <strahl/bounds/aabb_volume.h>
#include <strahl/build/side_tree.h>

namespace strahl {

SideTree make_side_tree(BoxTree tree) {
  SideTree out;
  for (const HierarchyNode& node : tree.nodes.nodes) out.add_volume(AabbVolume(node.box));
  out.nodes = std::move(tree.nodes), out.cost = tree.cost;
  return out;
}

SideTree with_things(SideTree tree, std::span<const SideTree::Thing> things) {
  if (tree.things.empty()) {
    tree.things.assign(things.begin(), things.end());
    const std::uint32_t base = things.empty() ? 0 : things.front().first;
    for (SideTree::Thing& thing : tree.things) thing.first -= base;
    return tree;
  }
  const std::uint32_t base = things.front().first;
  for (SideTree::Thing& run : tree.things) {
    const std::span own = things.subspan(run.first, run.size);
    run.tree = std::make_shared<const SideTree>(with_things(*run.tree, own));
    run.first = own.front().first - base;
    run.size = own.back().first + own.back().size - own.front().first;
  }
  return tree;
}

}  // namespace strahl
