// traverse/nested_dda.h - the loop over grids whose cells may list further grids.
//
// Source: [JevansWyvill1989] for sub-grids of cells, [CazalsPuech1997] for grids as objects.
// How: a cell's primitives first, then the grids it lists, each by a dda() of its own. Grids lie in
//   each other no deeper than builders allow (build/nested_grids.h), so the recursion is as deep,
//   a few hundred bytes each. A grid begins and ends its own sweep, so nothing of the outer sweep's
//   state, slabs open at ties included, has to fit it: the cells visited are all cells of the inner
//   grid that the ray may touch.
// Why no hit is lost: a point of a hit lies in a closed cell of the outer grid, which is visited
//   and lists the primitive or a grid whose closed box holds the point; and so on inward. A grid
//   that is passed over a second time has offered all its hits that were within t_max() then, which
//   never grows.
// Thread safety: pure besides what it is given.
#pragma once

#include <strahl/traverse/dda.h>
#include <strahl/traverse/leaf.h>

namespace strahl {

/// For grids that each lie in one cell: all are entered.
struct EveryGrid {
  static constexpr bool admit(std::uint32_t) { return true; }
};

/// One ray on its way through nested grids; use trace_nested().
template <class Grids, class Seen, class Prims, class Q, class C>
class NestedSweep {
 public:
  NestedSweep(const Grids& grids, Seen& seen, Prims& prims, const PreparedRay& ray, Q& query,
              C& counters)
      : grids_(grids), seen_(seen), prims_(prims), ray_(ray), query_(query), counters_(counters) {}

  bool visit_grid(std::uint32_t grid) {
    bool is_stopped = false;
    dda(grids_.cells(grid), ray_, [this, grid, &is_stopped](const CellVisit& cell) {
      if (!may_hit_before(cell.t_enter, query_.t_max())) return kStopCells;
      counters_.traversal_step();
      is_stopped = visit_list(grids_.list(grid, cell.index));
      return is_stopped ? kStopCells : 1;
    });
    return is_stopped;
  }

 private:
  /// A cell that lists a grid is no leaf.
  bool visit_list(std::span<const std::uint32_t> list) {
    if (list.empty() || !Grids::is_grid(list.back()))
      return test_leaf(list, prims_, ray_, query_, counters_);
    const std::span<const std::uint32_t> own = Grids::primitives(list);
    if (test_references(own, prims_, ray_, query_, counters_)) return true;
    for (const std::uint32_t entry : list.subspan(own.size()))
      if (seen_.admit(entry) && visit_grid(Grids::grid_of(entry))) return true;
    return false;
  }

  const Grids& grids_;
  Seen& seen_;
  Prims& prims_;
  const PreparedRay& ray_;
  Q& query_;
  C& counters_;
};

/// Offers to the query every hit of the ray with what the grid holds that it may want.
/// @param seen admit(entry) says whether a listed grid has to be entered
/// @return whether the query stopped the traversal
template <class Grids, class Seen, class Prims, class Q, class C>
bool trace_nested(const Grids& grids, std::uint32_t grid, Seen& seen, Prims& prims,
                  const PreparedRay& ray, Q& query, C& counters) {
  return NestedSweep(grids, seen, prims, ray, query, counters).visit_grid(grid);
}

}  // namespace strahl
