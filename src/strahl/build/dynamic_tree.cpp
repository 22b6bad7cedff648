#include <algorithm>
#include <vector>

#include <strahl/build/dynamic_tree.h>

namespace strahl {
namespace {

constexpr std::uint32_t kNone = LinkedNode::kNone;

/// Neighbours become pairs until one node is left; kNone of none.
std::uint32_t join_all(LinkedTree& tree, std::vector<std::uint32_t> nodes) {
  while (nodes.size() > 1) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < nodes.size(); i += 2)
      nodes[kept++] = i + 1 < nodes.size() ? tree.join(nodes[i], nodes[i + 1]) : nodes[i];
    nodes.resize(kept);
  }
  return nodes.empty() ? kNone : nodes.front();
}

std::uint32_t add_leaf(LinkedTree& tree, std::uint32_t reference, const Aabb& box) {
  tree.nodes.push_back({box, kNone, kNone, reference});
  return static_cast<std::uint32_t>(tree.nodes.size() - 1);
}

/// A subtree to look at, and by how much all above it grow.
struct Waiting {
  double inherited;
  std::uint32_t number, node;
  bool operator<(const Waiting& o) const {
    return inherited != o.inherited ? inherited > o.inherited : number > o.number;
  }
};

/// The node beside which a box costs least. Below a node it costs at least its own area more.
std::uint32_t find_place(const LinkedTree& tree, const Aabb& box) {
  const double least = box.half_area();
  std::uint32_t best = tree.root, pushed = 0;
  double best_cost = Aabb::kInf;
  std::vector<Waiting> waiting{{0.0, 0, tree.root}};
  for (int visits = 0; !waiting.empty() && visits < kMaxPlaceVisits; ++visits) {
    std::pop_heap(waiting.begin(), waiting.end());
    const Waiting at = waiting.back();
    waiting.pop_back();
    if (at.inherited + least >= best_cost) break;
    const LinkedNode& node = tree.nodes[at.node];
    const double joined = Aabb::join(node.box, box).half_area();
    if (at.inherited + joined < best_cost) best_cost = at.inherited + joined, best = at.node;
    if (node.is_leaf()) continue;
    const double inherited = at.inherited + joined - node.box.half_area();
    for (const std::uint32_t child : {node.left, node.right}) {
      waiting.push_back({inherited, ++pushed, child});
      std::push_heap(waiting.begin(), waiting.end());
    }
  }
  return best;
}

}  // namespace

LinkedTree make_linked(const Hierarchy& hierarchy, std::span<const Aabb> boxes) {
  LinkedTree tree;
  tree.nodes.reserve(2 * hierarchy.references.size());
  std::vector<std::uint32_t> made(hierarchy.nodes.size(), kNone);
  for (std::size_t i = hierarchy.nodes.size(); i-- > 0;) {
    const HierarchyNode& node = hierarchy.nodes[i];
    std::vector<std::uint32_t> parts;
    for (std::uint32_t k = 0; k < node.count; ++k) {
      const std::uint32_t reference = hierarchy.references[node.first + k];
      if (!boxes[reference].is_empty())
        parts.push_back(add_leaf(tree, reference, boxes[reference]));
    }
    for (std::uint32_t k = 0; k < node.children; ++k)
      if (made[node.first + k] != kNone) parts.push_back(made[node.first + k]);
    made[i] = join_all(tree, std::move(parts));
  }
  if (!made.empty() && made[0] != kNone) tree.root = made[0];
  return tree;
}

void insert_leaf(LinkedTree& tree, std::uint32_t reference, const Aabb& box) {
  if (tree.nodes.empty()) {
    tree.root = add_leaf(tree, reference, box);
    return;
  }
  const std::uint32_t beside = find_place(tree, box), leaf = add_leaf(tree, reference, box);
  const auto pair = static_cast<std::uint32_t>(tree.nodes.size());
  tree.nodes.push_back({Aabb::join(tree.nodes[beside].box, box), kNone, beside, leaf});
  tree.replace_child(beside, pair);
  tree.nodes[beside].parent = tree.nodes[leaf].parent = pair;
  tree.refit_from(tree.nodes[pair].parent);
}

}  // namespace strahl
