// structures/bvh/bvh_tree.h - a hierarchy whose nodes hold volumes of one type.
//
// Layout:     nodes of a volume and 8 bytes (32 in all for boxes), the children of a node
//             consecutive; references ascending inside each leaf.
// Invariants: every primitive that can be hit is in a leaf, and in all volumes on the way to it, or
//             the part of it that its leaf is for; children come after their parent; no leaf is
//             deeper than kBvhMaxDepth, no node has more than kBvhMaxArity children.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <utility>

#include <strahl/bounds/bounding_volume.h>
#include <strahl/structures/bvh/bvh_build.h>
#include <strahl/structures/bvh/volume_fit.h>
#include <strahl/structures/bvh/volume_tree.h>
#include <strahl/traverse/best_first.h>

namespace strahl {

/// A leaf refers to `size` references from `first`, an inner node has that many children there.
template <class V>
struct BvhNode {
  static constexpr std::uint32_t kInner = 0x80000000u;
  static constexpr int kAxisShift = 29;  ///< two bits below kInner
  static constexpr std::uint32_t kMostSize = (1u << kAxisShift) - 1;

  V volume;
  std::uint32_t first = 0, size_and_kind = 0;

  bool is_leaf() const { return size_and_kind < kInner; }
  std::uint32_t size() const { return size_and_kind & kMostSize; }
  /// Along which the children of an inner node ascend, where the tree is visited by direction.
  int axis() const { return static_cast<int>(size_and_kind >> kAxisShift & 3u); }
};

template <class V>
class BvhTree final : public VolumeTree {
 public:
  using Node = BvhNode<V>;

  /// @param volumes one per node
  /// @param world   encloses everything
  /// @param axes    one per node, see order_children(); or none
  BvhTree(Hierarchy hierarchy, std::vector<V> volumes, const Aabb& world, const SahCost& cost,
          std::span<const std::uint8_t> axes);

  void trace(BvhTraversal traversal, const PreparedRay& ray, LeafQuery& leaves,
             NoCounters& counters) const override {
    trace_in(traversal, ray, leaves, counters);
  }
  void trace(BvhTraversal traversal, const PreparedRay& ray, LeafQuery& leaves,
             Counters& counters) const override {
    trace_in(traversal, ray, leaves, counters);
  }
  VolumeEntry first_volume(const PreparedRay& ray, int depth) const override;
  const BuildReport& report() const override { return report_; }
  Hierarchy hierarchy() const override;
  std::optional<Hierarchy> box_hierarchy() const override;
  SideTree side_tree() const override;
  void validate(const PrimitiveSource& source, bool refers_once) const override;
  void hash_into(Hash64& hash) const override;

  const std::vector<Node>& nodes() const { return nodes_; }
  std::span<const std::uint32_t> references(const Node& leaf) const {
    return {references_.data() + leaf.first, leaf.size()};
  }
  const std::vector<std::uint32_t>& references() const { return references_; }
  /// Whether all inner nodes have two children.
  bool is_binary() const { return nodes_.size() + 1 == 2 * report_.leaves; }
  const Aabb& world() const { return world_; }

 private:
  template <class C>
  void trace_in(BvhTraversal traversal, const PreparedRay& ray, LeafQuery& leaves,
                C& counters) const;
  /// Of the volumes as stored, so that it can be told from the nodes alone.
  double sah_cost() const;

  template <class>
  friend class BvhChecker;
  friend class BvhBreaker;  ///< plants faults for the tests
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> references_;
  Aabb world_;
  SahCost cost_;
  BuildReport report_;
};

/// Children are visited in the order of the tree, of their entries, or of the tree or against it,
/// as the ray runs along the node's axis.
enum class BvhOrder { tree, entry, direction };

/// A tree as one ray sees it, for the loops of traverse/. Tree and ray must outlive it.
/// @tparam kArity most children of a node; 2 also means no fewer
template <class V, BvhOrder kOrder, int kArity = kBvhMaxArity>
class BvhView {
 public:
  static constexpr int kMaxChildren = kArity;
  static constexpr int kMaxDepth = kBvhMaxDepth;

  BvhView(const BvhTree<V>& tree, const PreparedRay& ray)
      : nodes_(tree.nodes().data()),
        references_(tree.references().data()),
        ray_(ray, tree.world()) {}

  NodeVisit enter(const PreparedRay& ray) const {
    return {0, node(0).volume.clip(ray_, {ray.t_enter, ray.t_exit})};
  }
  bool is_leaf(std::uint32_t i) const { return node(i).is_leaf(); }
  std::span<const std::uint32_t> references(std::uint32_t i) const {
    return {references_ + node(i).first, node(i).size()};
  }
  template <class C>
  int expand(const PreparedRay& ray, const NodeVisit& at, NodeVisit* child, C& counters) const {
    const std::uint32_t first = node(at.node).first, size = node(at.node).size();
    counters.volume_tests(static_cast<int>(size));
    if constexpr (kArity == 2) return expand_pair(first, at.span, child);
    const bool is_backward = kOrder == BvhOrder::direction && ray.negative[node(at.node).axis()];
    int entered = 0;
    for (std::uint32_t k = 0; k < size; ++k) {
      const std::uint32_t i = first + (is_backward ? size - 1 - k : k);
      const Interval span = node(i).volume.clip(ray_, at.span);
      if (span.t_enter > span.t_exit) continue;
      int to = entered++;
      if constexpr (kOrder == BvhOrder::entry) {
        for (; to > 0 && span.t_enter < child[to - 1].span.t_enter; --to) child[to] = child[to - 1];
      }
      child[to] = {i, span};
    }
    return entered;
  }

 private:
  /// The same for two children, which then stay in registers.
  int expand_pair(std::uint32_t first, const Interval& span, NodeVisit* child) const {
    child[0] = {first, node(first).volume.clip(ray_, span)};
    child[1] = {first + 1, node(first + 1).volume.clip(ray_, span)};
    const bool left = child[0].span.t_enter <= child[0].span.t_exit;
    const bool right = child[1].span.t_enter <= child[1].span.t_exit;
    static_assert(kArity != 2 || kOrder != BvhOrder::direction);
    if (left && right) {
      if (kOrder == BvhOrder::entry && child[1].span.t_enter < child[0].span.t_enter)
        std::swap(child[0], child[1]);
      return 2;
    }
    if (right) child[0] = child[1];
    return left || right;
  }

  const BvhNode<V>& node(std::uint32_t i) const { return nodes_[i]; }

  const BvhNode<V>* nodes_;
  const std::uint32_t* references_;
  typename V::RayData ray_;
};

}  // namespace strahl
