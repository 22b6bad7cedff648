// structures/grid/grid.h - equal cells, each with the list of primitives that touch it.
//
// Source: [Fujimoto1986], [AmanatidesWoo1987]; resolution rules [Woo1992], [Klimaszewski1994];
//   lists as one array [LagaeDutre2008].
// Layout: cells x fastest; built by build/cell_grid.h, lists in build/cell_lists.h.
// Invariants: cells are closed: what lies in the plane between two cells is listed in both.
// Why no hit is lost: the point of a hit lies in a closed cell that lists the primitive, and dda()
//   visits every closed cell that a point of the ray lies in. A hit is kept whichever cell it was
//   found from, and the traversal ends only when the next cell begins beyond it.
// Differs from the papers: parameters are computed anew per step; close to edges and corners of
//   cells all cells around are visited.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <strahl/build/cell_grid.h>
#include <strahl/traverse/dda.h>
#include <strahl/traverse/leaf.h>
#include <strahl/traverse/mailbox.h>

namespace strahl {

/// README.md says how the defaults were measured.
struct GridOptions : CellGridOptions {
  bool mailbox = true;
};

OptionTable<GridOptions> option_fields(const GridOptions*);

/// O(n^(1/3)) cells per ray. 4 bytes per cell and per reference.
/// Throws Error{resource} above the memory limit or beyond 2^32 references.
class Grid {
 public:
  using Options = GridOptions;
  static constexpr const char* kName = "grid";
  static constexpr const char* kTitle = "uniform grid of cells";
  static constexpr bool kRefersOnce = false;

  Grid(const PrimitiveSource& source, const Options& options, const BuildContext& context);

  template <class Prims, class Q, class C>
  void trace(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    if (grid_.lists.references.empty()) return;
    if (has_mailbox_) {
      MailedPrims<Prims> mailed(prims);
      visit_cells(mailed, ray, query, counters);
    } else {
      visit_cells(prims, ray, query, counters);
    }
  }

  const BuildReport& report() const { return report_; }
  /// Throws std::logic_error naming the first broken invariant. O(cells touched by boxes * log n).
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const;

 private:
  template <class Prims, class Q, class C>
  void visit_cells(Prims& prims, const PreparedRay& ray, Q& query, C& counters) const {
    // Named captures: with [&] their order would depend on whether counters are called.
    dda(grid_.cells, ray, [this, &prims, &ray, &query, &counters](const CellVisit& cell) {
      if (!may_hit_before(cell.t_enter, query.t_max())) return kStopCells;
      counters.traversal_step();
      return test_leaf(grid_.lists[cell.index], prims, ray, query, counters) ? kStopCells : 1;
    });
  }

  CellGrid grid_;
  bool is_exact_, has_mailbox_;
  BuildReport report_;
};

}  // namespace strahl
