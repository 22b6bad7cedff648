// build/cell_grid.h - from primitives to a grid of equal cells that list them, as options say.
//
// Source: resolution rules [Woo1992], [Klimaszewski1994], see build/grid_resolution.h.
// Invariants: those of build/cell_lists.h; check_cell_grid() tests them.
// Thread safety: pure functions.
#pragma once

#include <strahl/base/hash.h>
#include <strahl/base/options.h>
#include <strahl/build/build_report.h>
#include <strahl/build/cell_lists.h>

namespace strahl {

enum class GridResolution { woo, cubic, fixed };

/// What all structures over one grid of cells let a user choose.
struct CellGridOptions {
  GridResolution resolution = GridResolution::cubic;
  double density = 4.0;
  int nx = 16, ny = 16, nz = 16;
  bool exact = true;
  int max_cells = 1 << 26;
};

/// The rows of CellGridOptions in the table of O, which is derived from it.
template <class O>
OptionTable<O> cell_grid_fields() {
  return {
      option<O, GridResolution>(
          "resolution", &O::resolution,
          {{"woo", GridResolution::woo},
           {"cubic", GridResolution::cubic},
           {"fixed", GridResolution::fixed}},
          "cells per axis: by the longest axis, as cubic as possible, or nx, ny, nz"),
      option<O>("density", &O::density, 0.001, 1000.0, "cells per primitive, not with fixed"),
      option<O>("nx", &O::nx, 1, 1024, "cells along x with fixed"),
      option<O>("ny", &O::ny, 1, 1024, "cells along y with fixed"),
      option<O>("nz", &O::nz, 1, 1024, "cells along z with fixed"),
      option<O>("exact", &O::exact, "list a triangle where it is, not where its box is"),
      option<O>("max_cells", &O::max_cells, 1, 1 << 30, "coarser where there would be more cells"),
  };
}

struct CellGrid {
  UniformCells cells;
  CellLists lists;
};

/// @param most references that the caller can hold, below 2^32  @param what for messages
/// Throws Error{resource} above the memory limit and, with fixed cells, beyond `most` references;
/// otherwise the grid is made coarser.
CellGrid make_cell_grid(const PrimitiveSource& source, const CellGridOptions& options,
                        std::uint64_t most, const char* what, const BuildContext& context);

/// The same over given primitives, into a given box; empty where make_cell_grid() would throw for
/// too many references. @param owned bytes that the caller holds, without input.refs
std::optional<CellGrid> fit_cell_grid(CellListInput input, const Aabb& box,
                                      const CellGridOptions& options, std::uint64_t owned,
                                      const BuildContext& context);

/// Counts and cost of a grid; bytes are those of the lists.
BuildReport report_of(const CellGrid& grid);

/// Adds where the cells are.
void hash_into(Hash64& hash, const UniformCells& cells);

/// Throws std::logic_error naming the first broken invariant of the lists or wrong count of the
/// report. O(cells touched by boxes * log n).
/// @param exact as built  @param what the structure, for messages
void check_cell_grid(const CellGrid& grid, const BuildReport& report, bool exact,
                     const PrimitiveSource& source, const char* what);

}  // namespace strahl
