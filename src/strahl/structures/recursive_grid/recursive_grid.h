// structures/recursive_grid/recursive_grid.h - a grid whose crowded cells are grids themselves.
//
// Source: [JevansWyvill1989]; resolution rules [Woo1992], [Klimaszewski1994].
// Layout: nested grids (build/nested_grids.h); grid 0 is the outermost.
// Invariants: those of nested grids; sub-grids take at most max_growth words per primitive.
// Why no hit is lost: traverse/nested_dda.h says so.
// Differs from the paper: primitives are clipped to the cell before they are listed in its grid,
//   unless exact=off; a sub-grid must fit the limit on growth and, with decide=cost, be expected to
//   save work.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <strahl/build/nested_grids.h>
#include <strahl/traverse/mailbox.h>
#include <strahl/traverse/nested_dda.h>

namespace strahl {

/// README.md shows what the defaults cost.
struct RecursiveGridOptions : CellGridOptions, NestingOptions {
  bool mailbox = true;
};

OptionTable<RecursiveGridOptions> option_fields(const RecursiveGridOptions*);

/// O(n^(1/3)) cells per ray, more where grids are nested. 4 bytes per cell and per reference, 96
/// per grid. Throws Error{resource} above the memory limit or beyond 2^31 primitives.
class RecursiveGrid {
 public:
  using Options = RecursiveGridOptions;
  static constexpr const char* kName = "recursive_grid";
  static constexpr const char* kTitle = "grid whose crowded cells are grids";
  static constexpr bool kRefersOnce = false;

  RecursiveGrid(const PrimitiveSource& source, const Options& options, const BuildContext& context);

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (grids_.entries.empty()) return;
    EveryGrid every;
    if (has_mailbox_) {
      MailedPrims<Prims> mailed(prims);
      trace_nested(grids_, 0, every, mailed, ray, query, counters);
    } else {
      trace_nested(grids_, 0, every, prims, ray, query, counters);
    }
  }

  const BuildReport& report() const { return report_; }
  /// Throws std::logic_error naming the first broken invariant. O(cells touched by boxes * log n)
  /// per level.
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const { strahl::hash_into(hash, grids_); }

 private:
  NestedGrids grids_;
  double max_growth_;
  bool is_exact_, has_mailbox_;
  BuildReport report_;
};

}  // namespace strahl
