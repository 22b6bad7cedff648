// structures/bvh/bvh.h - bounding volume hierarchy: primitives divided among boxes.
//
// Paper:      [RubinWhitted1980]; SAH builders [GoldsmithSalmon1987, Wald2007].
// Layout:     32-byte nodes, children of a node adjacent (one cache line for both), boxes as floats
//             rounded outward; references ascending inside each leaf.
// Invariants: every primitive that can be hit is in exactly one leaf; a node's box encloses those
//             below it; children come after their parent; no leaf is deeper than kMaxDepth.
// Differs from the paper: boxes are tested in double with the margins of math/margin.h.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/base/hash.h>
#include <strahl/build/build_report.h>
#include <strahl/build/hierarchy.h>
#include <strahl/geometry/primitive_source.h>
#include <strahl/structures/bvh/bvh_build.h>
#include <strahl/structures/bvh/bvh_options.h>
#include <strahl/traverse/walk.h>

namespace strahl {

/// O(log n) expected per ray. 32 bytes per node, 4 per reference.
class Bvh {
 public:
  using Options = BvhOptions;
  static constexpr const char* kName = "bvh";
  static constexpr const char* kTitle = "bounding volume hierarchy";
  static constexpr bool kRefersOnce = true;
  static constexpr int kMaxChildren = 2;
  static constexpr int kMaxDepth = kBvhMaxDepth;

  Bvh(const PrimitiveSource& source, const Options& options, const BuildContext& context);

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (!nodes_.empty()) walk(*this, prims, ray, query, counters);
  }

  BuildReport report() const { return report_; }
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const;

  // What walk() asks for.
  NodeVisit enter(const PreparedRay& ray) const {
    return {0, clip(nodes_[0], ray, {ray.t_enter, ray.t_exit})};
  }
  bool is_leaf(std::uint32_t node) const { return nodes_[node].count > 0; }
  std::span<const std::uint32_t> references(std::uint32_t node) const {
    return {references_.data() + nodes_[node].first, nodes_[node].count};
  }
  template <class C>
  int expand(const PreparedRay& ray, const NodeVisit& at, NodeVisit* child, C& counters) const {
    counters.volume_tests(2);
    const std::uint32_t first = nodes_[at.node].first;
    child[0] = {first, clip(nodes_[first], ray, at.span)};
    child[1] = {first + 1, clip(nodes_[first + 1], ray, at.span)};
    const bool left = child[0].span.t_enter <= child[0].span.t_exit;
    const bool right = child[1].span.t_enter <= child[1].span.t_exit;
    if (left && right) {
      if (child[1].span.t_enter < child[0].span.t_enter) std::swap(child[0], child[1]);
      return 2;
    }
    if (right) child[0] = child[1];
    return left || right;
  }

 private:
  /// Leaf: count references from `first`. Inner: count 0, children `first` and `first` + 1.
  struct Node {
    float lo[3];
    float hi[3];
    std::uint32_t first, count;

    Aabb box() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
  };
  static_assert(sizeof(Node) == 32);

  static Interval clip(const Node& n, const PreparedRay& ray, const Interval& span) {
    return clip_to_box(ray, {n.lo[0], n.lo[1], n.lo[2]}, {n.hi[0], n.hi[1], n.hi[2]}, span);
  }
  static Node make_node(const HierarchyNode& from);
  /// Of the boxes as stored, so that it can be told from the nodes alone.
  double sah_cost() const;

  friend class BvhChecker;
  friend class BvhBreaker;  ///< plants faults for the tests
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> references_;
  SahCost cost_;
  BuildReport report_;
};

}  // namespace strahl
