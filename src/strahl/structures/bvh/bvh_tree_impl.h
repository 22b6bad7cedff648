// structures/bvh/bvh_tree_impl.h - the definitions of BvhTree, included once per kind of volume.
#pragma once

#include <stdexcept>

#include <strahl/bounds/all_volumes.h>
#include <strahl/structures/bvh/bvh_check.h>
#include <strahl/structures/bvh/bvh_tree.h>

namespace strahl {

template <class V>
BvhTree<V>::BvhTree(Hierarchy hierarchy, std::vector<V> volumes, const Aabb& world,
                    const SahCost& cost, std::span<const std::uint8_t> axes)
    : references_(std::move(hierarchy.references)), world_(world), cost_(cost) {
  nodes_.reserve(volumes.size());
  std::uint64_t owned = 0;  // by the volumes besides themselves
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    const HierarchyNode& from = hierarchy.nodes[i];
    if (from.children > static_cast<std::uint32_t>(kBvhMaxArity) || from.count > Node::kMostSize)
      throw std::logic_error("bvh: a node of the hierarchy has too many children or references");
    const std::uint32_t axis = axes.empty() ? 0u : std::uint32_t{axes[i]} << Node::kAxisShift;
    const std::uint32_t size = from.is_leaf() ? from.count : from.children | axis | Node::kInner;
    owned += volumes[i].bytes() - sizeof(V);
    nodes_.push_back({std::move(volumes[i]), from.first, size});
    report_.leaves += from.is_leaf();
  }
  report_.nodes = nodes_.size();
  report_.references = references_.size();
  report_.depth = static_cast<std::uint64_t>(hierarchy.depth());
  report_.bytes =
      nodes_.capacity() * sizeof(Node) + owned + references_.capacity() * sizeof(std::uint32_t);
  report_.sah_cost = sah_cost();
}

template <class V>
template <class C>
void BvhTree<V>::trace_in(BvhTraversal traversal, const PreparedRay& ray, LeafQuery& leaves,
                          C& counters) const {
  switch (traversal) {
    case BvhTraversal::dfs:
      return walk(BvhView<V, BvhOrder::tree>(*this, ray), leaves, ray, leaves, counters);
    case BvhTraversal::ordered:
      return walk(BvhView<V, BvhOrder::entry>(*this, ray), leaves, ray, leaves, counters);
    case BvhTraversal::direction:
      return walk(BvhView<V, BvhOrder::direction>(*this, ray), leaves, ray, leaves, counters);
    case BvhTraversal::heap:
      return walk_best_first(BvhView<V, BvhOrder::tree>(*this, ray), leaves, ray, leaves, counters);
  }
}

template <class V>
VolumeEntry BvhTree<V>::first_volume(const PreparedRay& ray, int depth) const {
  const typename V::RayData data(ray, world_);
  VolumeEntry first;
  std::vector<std::pair<std::uint32_t, int>> waiting{{0, 0}};
  while (!waiting.empty()) {
    const auto [at, level] = waiting.back();
    waiting.pop_back();
    const Node& node = nodes_[at];
    if (level < depth && !node.is_leaf()) {
      for (std::uint32_t c = 0; c < node.size(); ++c)
        waiting.emplace_back(node.first + c, level + 1);
      continue;
    }
    const Interval span = node.volume.clip(data, {ray.t_enter, ray.t_exit});
    const bool comes_from_outside = span.t_enter > ray.t_enter && span.t_enter <= span.t_exit;
    if (comes_from_outside && span.t_enter < first.t) first = {span.t_enter, at};
  }
  return first;
}

template <class V>
double BvhTree<V>::sah_cost() const {
  const double whole = nodes_[0].volume.half_area();
  double sum = 0.0;
  for (const Node& node : nodes_) {
    // Volumes beyond float's range are without end: every line is taken to meet all of them.
    const double part = whole < Aabb::kInf ? node.volume.half_area() : whole;
    const double share = part < Aabb::kInf ? sah_share(part, whole) : 1.0;
    sum += share * (node.is_leaf() ? sah_leaf_cost(cost_, node.size()) : cost_.traverse);
  }
  return sum / cost_.traverse;
}

template <class V>
void BvhTree<V>::hash_into(Hash64& hash) const {
  for (const Node& node : nodes_) {
    if constexpr (std::is_trivially_copyable_v<V>) {
      static_assert(alignof(V) == sizeof(float));  // floats only: no padding
      hash.add_bytes(&node.volume, sizeof node.volume);
    } else {
      if constexpr (requires { node.volume.kind(); }) hash.add(node.volume.kind());
      hash.add(node.volume.half_area()), hash.add(node.volume.volume());
    }
    hash.add(node.first), hash.add(node.size_and_kind);
  }
  hash.add(std::span<const std::uint32_t>(references_));
}

template <class V>
Hierarchy BvhTree<V>::hierarchy() const {
  Hierarchy out;
  out.nodes.reserve(nodes_.size());
  for (const Node& node : nodes_) {
    const std::uint32_t size = node.size();
    out.nodes.push_back({{}, node.first, node.is_leaf() ? 0 : size, node.is_leaf() ? size : 0});
  }
  out.references = references_;
  return out;
}

template <class V>
std::optional<Hierarchy> BvhTree<V>::box_hierarchy() const {
  if constexpr (std::is_same_v<V, AabbVolume> || std::is_same_v<V, KdopVolume<6>>) {
    Hierarchy out = hierarchy();
    for (std::size_t i = 0; i < nodes_.size(); ++i) out.nodes[i].box = nodes_[i].volume.box();
    return out;
  }
  return std::nullopt;
}

template <class V>
SideTree BvhTree<V>::side_tree() const {
  SideTree out;
  for (const Node& node : nodes_) out.add_volume(node.volume);
  out.nodes = hierarchy();
  return out;
}

template <class V>
void BvhTree<V>::validate(const PrimitiveSource& source, bool refers_once) const {
  BvhChecker<V>(*this, source, refers_once).run();
}

}  // namespace strahl
