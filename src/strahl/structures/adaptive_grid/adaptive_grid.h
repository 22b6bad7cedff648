// structures/adaptive_grid/adaptive_grid.h - grids over clusters of primitives, under a hierarchy
// of boxes.
//
// Source: [KlimaszewskiSederberg1997]; clusters in agglomerate.h, sub-grids [JevansWyvill1989].
// Layout: a binary tree (build/tree.h); a leaf refers to one thing: a primitive, or a grid of the
//   nested grids (build/nested_grids.h), by its entry.
// Invariants: every primitive that can be hit is in one leaf or in one grid, with all of its cells;
//   every outermost grid is in one leaf; boxes of the tree enclose those below and what is in the
//   leaf; grids of clusters hold at least min_cluster primitives; with orphans=grid there is at
//   most one more grid, and no leaf with a primitive.
// Why no hit is lost: walk() enters every leaf whose box the ray may meet before its best hit;
//   traverse/nested_dda.h goes on.
// Differs from the paper: which pairs are tried to be joined; the tree is built top down by area.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <utility>

#include <strahl/build/nested_grids.h>
#include <strahl/build/tree.h>
#include <strahl/traverse/mailbox.h>
#include <strahl/traverse/nested_dda.h>
#include <strahl/traverse/walk.h>

namespace strahl {

enum class OrphanPlace { tree, grid };

/// README.md shows what the defaults cost.
struct AdaptiveGridOptions : CellGridOptions, NestingOptions {
  double f = 1.5;
  double m = 0.1;
  int min_cluster = 8;
  OrphanPlace orphans = OrphanPlace::tree;
  bool mailbox = true;

  AdaptiveGridOptions() { max_depth = 1; }
};

OptionTable<AdaptiveGridOptions> option_fields(const AdaptiveGridOptions*);

/// O(log n) nodes and a few cells per ray where clusters are far apart. 64 bytes per node, 4 per
/// cell and per reference, 96 per grid. Throws Error{resource} above the memory limit or beyond
/// 2^31 primitives.
class AdaptiveGrid {
 public:
  using Options = AdaptiveGridOptions;
  static constexpr const char* kName = "adaptive_grid";
  static constexpr const char* kTitle = "grids over clusters, under a hierarchy of boxes";
  static constexpr bool kRefersOnce = false;
  static constexpr int kMaxChildren = 2;
  static constexpr int kMaxDepth = 64;

  AdaptiveGrid(const PrimitiveSource& source, const Options& options, const BuildContext& context);

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (tree_.nodes.empty()) return;
    if (has_mailbox_) {
      MailedPrims<Prims> mailed(prims);
      trace_clusters(mailed, ray, query, counters);
    } else {
      trace_clusters(prims, ray, query, counters);
    }
  }

  // What walk() asks for. A node with a grid is an inner one: its cells are the leaves.
  NodeVisit enter(const PreparedRay& ray) const {
    return {0, clip(0, ray, {ray.t_enter, ray.t_exit})};
  }
  bool is_leaf(std::uint32_t node) const {
    return tree_.nodes[node].is_leaf() && !NestedGrids::is_grid(reference(node));
  }
  std::span<const std::uint32_t> references(std::uint32_t node) const {
    return {tree_.references.data() + tree_.nodes[node].first, tree_.nodes[node].count};
  }
  std::span<const std::uint32_t> inner_references(std::uint32_t node) const {
    return references(node);
  }
  template <class C>
  int expand(const PreparedRay& ray, const NodeVisit& at, NodeVisit* child, C& counters) const {
    const TreeNode& node = tree_.nodes[at.node];
    if (node.is_leaf()) return 0;
    counters.volume_tests(2);
    child[0] = {at.node + 1, clip(at.node + 1, ray, at.span)};
    child[1] = {node.right, clip(node.right, ray, at.span)};
    const bool left = !(child[0].span.t_enter > child[0].span.t_exit);
    const bool right = !(child[1].span.t_enter > child[1].span.t_exit);
    if (!left || (right && child[1].span.t_enter < child[0].span.t_enter))
      std::swap(child[0], child[1]);
    return left + right;
  }

  const BuildReport& report() const { return report_; }
  /// Throws std::logic_error naming the first broken invariant. O(cells touched by boxes * log n).
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const;

  const NestedGrids& grids() const { return grids_; }

 private:
  /// Enters grids where the tree refers to them.
  template <class Prims>
  struct ClusterPrims {
    const NestedGrids& grids;
    Prims& prims;

    template <class Q, class C>
    bool visit(std::uint32_t entry, const PreparedRay& ray, Q& query, C& counters) {
      if (!NestedGrids::is_grid(entry)) return prims.visit(entry, ray, query, counters);
      EveryGrid every;
      return trace_nested(grids, NestedGrids::grid_of(entry), every, prims, ray, query, counters);
    }
  };

  template <class Prims, class Q, class C>
  void trace_clusters(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    ClusterPrims<Prims> clusters{grids_, prims};
    walk(*this, clusters, ray, query, counters);
  }

  std::uint32_t reference(std::uint32_t node) const {
    return tree_.references[tree_.nodes[node].first];
  }
  Interval clip(std::uint32_t node, const PreparedRay& ray, const Interval& span) const {
    const Aabb& box = tree_.nodes[node].box;
    return clip_to_box(ray, box.lo, box.hi, span);
  }

  BuildReport count() const;
  friend class AdaptiveGridChecker;

  Tree tree_;
  NestedGrids grids_;
  double max_growth_;
  std::size_t min_cluster_;
  bool has_orphan_grid_, is_exact_, has_mailbox_;
  BuildReport report_;
};

}  // namespace strahl
