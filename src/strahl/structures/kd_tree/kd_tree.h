// structures/kd_tree/kd_tree.h - space divided by axis-perpendicular planes placed by the surface
// area heuristic.
//
// Source: [Kaplan1985], [MacDonaldBooth1990]; sweep and splicing after [WaldHavran2006].
// Layout: 8-byte nodes, depth first (build/kd_node.h); cells are implicit.
// Invariants: every split plane lies strictly inside its cell, so cells tile the root box; every
//   point of a primitive lies in some closed leaf cell that refers to the primitive.
// Why no hit is lost: by the second invariant the point of a hit lies in a closed cell that refers
//   to its primitive, and every closed cell that holds a point of the ray is visited
//   (traverse/plane.h).
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <strahl/base/hash.h>
#include <strahl/base/options.h>
#include <strahl/build/kd_policy.h>
#include <strahl/traverse/plane.h>

namespace strahl {

enum class KdSplit { automatic, sah_sweep, sah_sort, sah_naive, sah_binned, middle, median };
enum class KdAxis { longest, round_robin };

/// Defaults of the costs are measured, see README.md.
struct KdTreeOptions {
  KdSplit split = KdSplit::automatic;
  KdAxis axis = KdAxis::longest;
  int bins = 64;
  bool clip = true;
  double traverse_cost = 1.0;
  double intersect_cost = 0.7;
  double empty_bonus = 0.1;
  double empty_cut = 0.0;
  bool walls = false;
  int look_ahead = 0;
  int max_leaf = 1;
  int max_depth = 0;
  double min_volume = 0.0;
  bool cost_stop = true;
  int bad_splits = 2;
  bool retract = true;
  double max_growth = 32.0;
};

OptionTable<KdTreeOptions> option_fields(const KdTreeOptions*);

/// O(log n) expected per ray. 8 bytes per node, 4 per reference of a leaf with several.
/// Throws Error{resource} above the memory limit or beyond 2^30 nodes.
class KdTree {
 public:
  using Options = KdTreeOptions;
  static constexpr const char* kName = "kd_tree";
  static constexpr const char* kTitle = "space divided by axis-perpendicular planes";
  static constexpr bool kRefersOnce = false;
  static constexpr int kMaxChildren = 2;
  static constexpr int kMaxDepth = 64;

  KdTree(const PrimitiveSource& source, const Options& options, const BuildContext& context);

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
  template <class C>
  int expand(const PreparedRay& ray, const NodeVisit& at, NodeVisit* children, C&) const {
    const KdNode& node = tree_.nodes[at.node];
    return cross_plane(ray, {node.axis(), node.plane(), at.node + 1, node.right()}, at.span,
                       children);
  }

  const BuildReport& report() const { return report_; }
  /// Throws std::logic_error naming the first broken invariant. O(references * log n).
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const;

 private:
  KdArrays tree_;
  Aabb root_box_;
  SahCost cost_;
  int max_depth_ = 0;
  BuildReport report_;
};

}  // namespace strahl
