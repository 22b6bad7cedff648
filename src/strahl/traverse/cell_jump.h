// traverse/cell_jump.h - what dda() tells a cell action, and what it is told.
//
// Thread safety: values.
#pragma once

#include <cstddef>

#include <strahl/math/uniform_cells.h>

namespace strahl {

/// A cell to be looked into. Successive t_enter never decrease.
struct CellVisit {
  CellPosition at;
  std::size_t index;  ///< of Cells::index()
  double t_enter;     ///< no point of the cell is met before; compare by may_hit_before()
};

/// What a cell action returns instead of a jump to end the traversal.
inline constexpr int kStopCells = 0;

/// How far two cells are from each other, d being the differences of their positions: the largest
/// of |d|; their sum; the sum of d^2; or the largest of |d|, counting only cells that do not lie
/// behind on any axis as the ray goes.
enum class CellMetric { chessboard, city_block, euclid, octant };

/// How far to jump: cells that are less than `distance` away need no visit.
struct CellJump {
  int distance;  ///< kStopCells, or 1 for the next cell
  CellMetric metric = CellMetric::chessboard;
  unsigned layers = 0;  ///< bit a: only of cells in the same slab of axis a so much is known
};

}  // namespace strahl
