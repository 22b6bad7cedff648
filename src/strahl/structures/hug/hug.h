// structures/hug/hug.h - hierarchy of uniform grids: one for each cluster of primitives of a size.
//
// Source: [Cazals1995], [CazalsPuech1997]; the steps are those of hug_plan.h.
// Layout: nested grids (build/nested_grids.h); grid 0 is the outermost. A grid is listed, as an
//   object is, in all cells of another one that its box touches.
// Invariants: every primitive that can be hit is in one grid; a grid's box encloses what is in it;
//   every grid but the outermost is in one other, whose group is coarser; it holds at least
//   min_cluster primitives of its own group.
// Why no hit is lost: traverse/nested_dda.h says so.
// Differs from the papers: how sizes are cut into groups (size_groups.h); groups of like size are
//   one; primitives without a cluster go into the smallest coarser grid around them, not to the
//   outermost; the mailbox for grids is the ray's.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <strahl/build/nested_grids.h>
#include <strahl/traverse/mailbox.h>
#include <strahl/traverse/nested_dda.h>

namespace strahl {

/// README.md shows what the defaults cost.
struct HugOptions : CellGridOptions {
  int groups = 3;
  double ratio = 4.0;
  double connectivity = 0.0;
  int min_cluster = 8;
  bool mailbox = true;
};

OptionTable<HugOptions> option_fields(const HugOptions*);

/// O(n^(1/3)) cells per ray and grid. 4 bytes per cell and per reference, 96 per grid.
/// Throws Error{resource} above the memory limit or beyond 2^31 primitives.
class Hug {
 public:
  using Options = HugOptions;
  static constexpr const char* kName = "hug";
  static constexpr const char* kTitle = "hierarchy of uniform grids, one per cluster";
  static constexpr bool kRefersOnce = false;

  Hug(const PrimitiveSource& source, const Options& options, const BuildContext& context);

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (grids_.entries.empty()) return;
    SlotMailbox<256> seen;  // a grid stands in many cells of another
    if (has_mailbox_) {
      MailedPrims<Prims> mailed(prims);
      trace_nested(grids_, 0, seen, mailed, ray, query, counters);
    } else {
      trace_nested(grids_, 0, seen, prims, ray, query, counters);
    }
  }

  const BuildReport& report() const { return report_; }
  /// Throws std::logic_error naming the first broken invariant. O(cells touched by boxes * log n).
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const { strahl::hash_into(hash, grids_); }

  const NestedGrids& grids() const { return grids_; }

 private:
  NestedGrids grids_;
  std::size_t min_cluster_;
  bool is_exact_, has_mailbox_;
  BuildReport report_;
};

}  // namespace strahl
