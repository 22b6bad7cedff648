// build/kd_policy.h - what builders of trees that divide space by planes have in common: cells with
// their fragments, the cheapest plane, when to stop, nodes.
//
// Source: [WaldHavran2006]; bins for large cells.
// A policy of TopDown derives from KdPolicy and adds plan(), open() and divide().
// Thread safety: disjoint cells may be worked on at once.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <strahl/build/build_report.h>
#include <strahl/build/kd_node.h>
#include <strahl/build/memory_meter.h>
#include <strahl/build/space_sweep.h>

namespace strahl {

/// With automatic choice, cells with more fragments are divided at bins, smaller ones exactly.
inline constexpr std::size_t kAutoSweepLimit = 500'000;

/// How the cheapest plane at any end of a fragment is found; the tree is the same.
enum class KdSweep {
  splice,  ///< ends are sorted once and divided with their fragments
  sort,    ///< ends are sorted in every cell
  count,   ///< every plane is judged by counting all fragments
};

/// Where planes are looked for and when a cell stays whole.
struct KdRules {
  std::string_view name;  ///< of the structure, for messages
  SahCost cost;
  double empty_bonus = 0.1;
  KdSweep sweep = KdSweep::splice;
  double empty_cut = 0.0;  ///< empty part of a side that is cut off first; 0: none is
  bool walls = false;      ///< planes that triangles cover are taken first
  int look_ahead = 0;      ///< levels of planes counted behind the one looked for
  bool clip = true;        ///< bound the part of a primitive inside its cell
  int bins = 64;           ///< where planes are binned
  std::size_t sweep_limit = kAutoSweepLimit;  ///< cells with more fragments are binned
  std::size_t max_leaf = 1;
  int max_depth = 64;
  double min_volume = 0.0;  ///< smaller parts of the root's volume are not divided
  bool cost_stop = true;    ///< a cell stays whole where no plane costs less
  int bad_splits = 2;       ///< splits on a path that may cost more than a leaf
  bool retract = false;     ///< what costs no less than a leaf becomes one in the end
  double max_growth = 32.0;
};

/// A cell and the fragments in it.
struct CellWork {
  Aabb cell;
  std::vector<Fragment> fragments;
  SweepLists events;
  bool has_events = false;
  int bad_splits = 0;              ///< splits on the way here that cost more than a leaf
  int empty_cuts = 0;              ///< splits just above that cut off empty space
  double least_cost = Aabb::kInf;  ///< no plane costs less, where the cheapest was binned
  double spare = 0.0;              ///< references that planes may still add below this cell
  MemoryLease lease;
};

/// A tree under construction.
struct KdOutput : KdArrays {
  /// Fragments per node, if there is retraction.
  std::vector<std::uint32_t> counts;
};

/// What binning may have lost; sums do not depend on the order of the terms.
class BinningLosses {
 public:
  /// @param loss part of a plane's cost by which it may exceed the cheapest
  void add(double loss);
  void write(BuildReport& report) const;

 private:
  std::atomic<std::uint64_t> planes_{0}, sum_{0}, largest_{0};  ///< losses in units of 2^-32
};

class KdPolicy {
 public:
  using Output = KdOutput;

  KdPolicy(const PrimitiveSource& source, const KdRules& rules, const BuildContext& context,
           std::size_t primitives);

  CellWork make_root(std::span<const PrimRef> refs, const Aabb& box);

  // What TopDown asks for and all trees do alike.
  void leaf(CellWork&& given, Output& out);
  void link(Output& out, std::size_t inner) const { out.nodes[inner].link_right(out.nodes.size()); }
  void append(Output& out, Output&& right) const;
  std::size_t weight(const CellWork& work) const { return work.fragments.size(); }
  Output make_output() const { return {}; }
  /// Retracts, gives back what is not needed and describes the tree, but for the time.
  KdArrays finish(Output&& out, const Aabb& root, BuildReport& report);

 protected:
  /// Whether the cell stays whole whatever planes there are. Reports progress of large cells.
  bool must_be_leaf(const CellWork& work, int depth) const;
  /// The cheapest plane at any end of a fragment or at borders of bins. Sorts the ends when the
  /// cell is the first one on its path to be swept.
  SplitPlane find_cheapest_plane(CellWork& work);
  /// The plane that is cheapest if its sides are divided on, among the cheapest of several places.
  SplitPlane find_plane_ahead(CellWork& work);
  /// A plane that is taken, if it pays, before others are looked at: one that cuts off empty space,
  /// else one that triangles cover.
  SplitPlane find_first_plane(const CellWork& work) const;
  /// Whether a plane costs less than a leaf and adds no more references than are left.
  bool pays(const CellWork& work, const SplitPlane& plane) const;
  /// Whether a plane is worth it, and allowed by the limits; counts bad splits.
  bool may_divide(CellWork& work, const SplitPlane& plane) const;
  std::pair<CellWork, CellWork> divide_at(CellWork&& given, const SplitPlane& plane);
  /// Both parts keep the cell; `is_left` tells for every fragment where it goes.
  std::pair<CellWork, CellWork> divide_by(const CellWork& work, const std::vector<bool>& is_left);
  /// @param fragments in the cell of the node
  std::size_t add_node(KdNode node, std::size_t fragments, Output& out);

  const SahCost& sah() const { return rules_.cost; }
  bool looks_ahead() const { return rules_.look_ahead > 0; }
  PlaneCost cost_in(const Aabb& cell) const { return {cell, rules_.cost, rules_.empty_bonus}; }

 private:
  [[noreturn]] void refuse_size() const;
  void check_progress() const;
  bool may_split_badly(CellWork& work, const SplitPlane& plane) const;
  bool is_binned(const CellWork& work) const;
  void sort_ends(CellWork& work);
  SplitPlane find_plane_exactly(CellWork& work, const PlaneCost& cost);
  std::vector<SplitPlane> find_candidates(CellWork& work);
  double cost_ahead(const CellWork& work, const SplitPlane& plane, int levels);
  double least_cost_ahead(CellWork& work, int levels);
  std::pair<CellWork, CellWork> make_halves(const CellWork& work, const SplitPlane& plane);
  CellWork make_half(const CellWork& parent, const Aabb& cell, FragmentHalf half);

  KdRules rules_;
  const PrimitiveSource& source_;
  const BuildContext& context_;
  DivideRules divide_rules_;
  std::size_t total_;
  double root_volume_ = 0.0;
  MemoryMeter meter_;
  BinningLosses losses_;
  std::atomic<std::uint64_t> placed_{0};
};

/// Depth at which cells are no longer divided: `wanted`, or if that is 0, 8 + 1.3 log2(n) [pbrt], n
/// rounded up to a power of two, and at most `limit`.
int kd_depth_limit(int wanted, int limit, std::size_t primitives);

/// Counts nodes, leaves, references, bytes and cost. O(nodes).
BuildReport report_kd_tree(const KdArrays& tree, const Aabb& root, const SahCost& cost);

/// What validate_kd_tree() is told.
struct KdCheck {
  std::string_view name;  ///< of the structure, for messages
  Aabb root;
  int max_depth = 0;
  SahCost cost;
  bool may_filter = false;
  const BuildReport& report;
};

/// Throws std::logic_error naming the first broken invariant: planes strictly inside their cells,
/// every point of a primitive in a closed leaf cell that refers to it or in a filtered part, all of
/// a filtered primitive there and nowhere else; references, order and report. O(references log n).
void validate_kd_tree(const KdArrays& tree, const KdCheck& check, const PrimitiveSource& source);

}  // namespace strahl
