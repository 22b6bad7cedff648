// structures/kd_tree/kd_tree.h - space divided by axis-perpendicular planes placed by the surface
// area heuristic.
//
// Source: [Kaplan1985], [MacDonaldBooth1990]; sweep and splicing after [WaldHavran2006].
// Layout: 8-byte nodes, depth first (build/kd_node.h), or padded ones; cells are implicit. What
//   traversals without a stack need besides: kd_links.h.
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
#include <strahl/structures/kd_tree/kd_view.h>
#include <strahl/traverse/havran.h>

namespace strahl {

enum class KdSplit { automatic, sah_sweep, sah_sort, sah_naive, sah_binned, middle, median };
enum class KdAxis { longest, round_robin };
enum class KdTraversal { stack, havran, skip, ropes };

/// Defaults of the costs are measured, see README.md.
struct KdTreeOptions {
  KdSplit split = KdSplit::automatic;
  KdAxis axis = KdAxis::longest;
  int bins = 64;
  bool clip = true;
  double traverse_cost = 1.0;
  double intersect_cost = 0.7;
  double empty_bonus = 0.1;
  double empty_cut = 0.3;
  bool walls = false;
  int look_ahead = 0;
  int max_leaf = 1;
  int max_depth = 0;
  double min_volume = 0.0;
  bool cost_stop = true;
  int bad_splits = 2;
  bool retract = true;
  double max_growth = 32.0;
  KdTraversal traversal = KdTraversal::stack;
  KdNodeBytes node_bytes = KdNodeBytes::b8;
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
  static constexpr int kMaxDepth = kMaxKdDepth;

  KdTree(const PrimitiveSource& source, const Options& options, const BuildContext& context);

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (root_box_.is_empty()) return;
    if (traversal_ != KdTraversal::stack) return trace_otherwise(prims, ray, query, counters);
    if (nodes_.distance() == KdNodeBytes::b8)
      walk(view<false>(), prims, ray, query, counters);
    else
      walk(view<true>(), prims, ray, query, counters);
  }

  const BuildReport& report() const { return report_; }
  /// Throws std::logic_error naming the first broken invariant. O(references * log n).
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const;

 private:
  template <bool kIsPadded>
  KdView<kIsPadded> view() const {
    return {nodes_, references_, links_, root_box_};
  }
  template <class Prims, class Q, class C>
  void trace_otherwise(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (traversal_ == KdTraversal::havran)
      walk_by_points(view<true>(), prims, ray, query, counters);
    if (traversal_ == KdTraversal::skip) walk_by_skips(view<true>(), prims, ray, query, counters);
    if (traversal_ == KdTraversal::ropes) walk_by_ropes(view<true>(), prims, ray, query, counters);
  }
  void take(KdArrays tree, const Options& options, const BuildContext& context);

  KdNodes nodes_;
  std::vector<std::uint32_t> references_;
  KdLinks links_;
  KdTraversal traversal_ = KdTraversal::stack;
  Aabb root_box_;
  SahCost cost_;
  int max_depth_ = 0;
  BuildReport report_;
};

}  // namespace strahl
