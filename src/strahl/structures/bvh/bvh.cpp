#include <utility>

#include <strahl/math/float_round.h>
#include <strahl/structures/bvh/bvh.h>

namespace strahl {

Bvh::Bvh(const PrimitiveSource& source, const Options& options, const BuildContext& context)
    : cost_{options.traverse_cost, options.intersect_cost} {
  Hierarchy tree = build_bvh_hierarchy(source, options, context);
  if (tree.nodes.empty()) return;
  report_.depth = static_cast<std::uint64_t>(tree.depth());
  nodes_.reserve(tree.nodes.size());
  for (const HierarchyNode& node : tree.nodes) {
    nodes_.push_back(make_node(node));
    report_.leaves += node.is_leaf();
  }
  references_ = std::move(tree.references);
  report_.nodes = nodes_.size();
  report_.references = references_.size();
  report_.bytes = nodes_.capacity() * sizeof(Node) + references_.capacity() * sizeof(std::uint32_t);
  report_.sah_cost = sah_cost();
}

Bvh::Node Bvh::make_node(const HierarchyNode& from) {
  Node node{};
  for (int axis = 0; axis < 3; ++axis) {
    node.lo[axis] = float_below(from.box.lo[axis]);
    node.hi[axis] = float_above(from.box.hi[axis]);
  }
  node.first = from.first, node.count = from.count;
  return node;
}

double Bvh::sah_cost() const {
  const double whole = nodes_[0].box().half_area();
  double sum = 0.0;
  for (const Node& node : nodes_) {
    // Boxes beyond float's range are stored as infinite: every line is taken to meet all of them.
    const double share = whole < Aabb::kInf ? sah_share(node.box().half_area(), whole) : 1.0;
    sum += share * (node.count > 0 ? sah_leaf_cost(cost_, node.count) : cost_.traverse);
  }
  return sum / cost_.traverse;
}

void Bvh::hash_into(Hash64& hash) const {
  for (const Node& node : nodes_) {
    for (const float v : node.lo) hash.add(v);
    for (const float v : node.hi) hash.add(v);
    hash.add(node.first), hash.add(node.count);
  }
  hash.add(std::span<const std::uint32_t>(references_));
}

}  // namespace strahl
