// structures/ternary_tree/ternary_tree.h - kd-tree whose nodes have a third child for oversized
// primitives.
//
// Paper:      the ternary tree of a lecture, without a publication; costs after
//             [MacDonaldBooth1990], planes after [WaldHavran2006].
// Layout:     8-byte nodes (build/kd_node.h), depth first. A node with three children is a filter,
//             whose left subtree holds the oversized primitives, and the plane node of the rest.
// Invariants: those of kd_tree, for the rest and for every oversized subtree in the cell of its
//             filter; a filtered primitive is nowhere else below its filter; the right child of a
//             filter is a plane node; nothing is filtered within an oversized subtree.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <algorithm>

#include <strahl/base/hash.h>
#include <strahl/base/options.h>
#include <strahl/build/kd_policy.h>
#include <strahl/traverse/plane.h>

namespace strahl {

enum class OversizeRule { sides, area, median };
enum class OversizeKeep { automatic, list, tree };
enum class OversizeDecision { cost, always };
enum class OversizeOrder { first, last };
enum class TernarySplit { automatic, sah_sweep, sah_binned };

struct TernaryTreeOptions {
  OversizeRule rule = OversizeRule::area;
  double threshold = 0.5;
  double median_factor = 32.0;
  OversizeKeep keep = OversizeKeep::automatic;
  int list_max = 8;
  OversizeDecision decide = OversizeDecision::cost;
  OversizeOrder order = OversizeOrder::first;
  TernarySplit split = TernarySplit::automatic;
  int bins = 64;
  bool clip = true;
  double traverse_cost = 1.0;
  double intersect_cost = 0.7;
  int max_depth = 0;
  double max_growth = 32.0;
};

OptionTable<TernaryTreeOptions> option_fields(const TernaryTreeOptions*);

/// O(log n) expected per ray. 8 bytes per node, 4 per reference of a leaf with several.
/// Throws Error{resource} above the memory limit or beyond 2^30 nodes.
class TernaryTree {
 public:
  using Options = TernaryTreeOptions;
  static constexpr const char* kName = "ternary_tree";
  static constexpr const char* kTitle = "kd-tree with a third child for oversized primitives";
  static constexpr bool kRefersOnce = false;
  static constexpr int kMaxChildren = 3;
  static constexpr int kMaxDepth = 64;

  TernaryTree(const PrimitiveSource& source, const Options& options, const BuildContext& context);

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (!root_box_.is_empty()) walk(*this, prims, ray, query, counters);
  }

  NodeVisit enter(const PreparedRay& ray) const {
    return {0, clip_to_box(ray, root_box_.lo, root_box_.hi, {ray.t_enter, ray.t_exit})};
  }
  bool is_leaf(std::uint32_t node) const { return tree_.nodes[node].is_leaf(); }
  std::span<const std::uint32_t> references(std::uint32_t node) const {
    return tree_.nodes[node].references(tree_.references);
  }
  /// Oversized primitives are met anywhere in the cell; first, they bound the search in the rest.
  template <class C>
  int expand(const PreparedRay& ray, const NodeVisit& at, NodeVisit* children, C&) const {
    const bool filters = tree_.nodes[at.node].is_filter();
    const std::uint32_t index = filters ? tree_.nodes[at.node].right() : at.node;
    const KdNode& node = tree_.nodes[index];
    const bool begins = filters && oversized_first_;
    if (begins) children[0] = {at.node + 1, at.span};
    const int count =
        begins + cross_plane(ray, {node.axis(), node.plane(), index + 1, node.right()}, at.span,
                             children + begins);
    if (!filters || begins) return count;
    children[count] = {at.node + 1, at.span};
    return count + 1;
  }

  const BuildReport& report() const { return report_; }
  /// Throws std::logic_error naming the first broken invariant. O(references * log n).
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const;

 private:
  KdArrays tree_;
  Aabb root_box_;
  SahCost cost_;
  bool oversized_first_ = true;
  int max_depth_ = 0;
  BuildReport report_;
};

}  // namespace strahl
