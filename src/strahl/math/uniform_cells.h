// math/uniform_cells.h - a box divided into equal closed cells: the geometry of every grid.
//
// Plane i of an axis is where cell i begins and cell i - 1 ends: plane(axis, i) = lo + i * size,
// one formula for builders and traversals. It is monotone in i, and no other arithmetic decides
// where something lies: a position only gives a guess, which is then corrected against plane().
// Invariants: plane(axis, n) >= hi of the box. Let S = hi - lo exactly. extent = fl(S) >= S (1 -
// u),
//   fl(extent / n) >= S / n (1 - u)^2, times 1 + 8u, rounded, times n, rounded: at least
//   S (1 - u)^4 (1 + 8u) >= S; so lo + n * size is at least hi before its rounding, and after it,
//   as hi is a double.
// Thread safety: values.
#pragma once

#include <array>
#include <cstddef>

#include <strahl/math/aabb.h>

namespace strahl {

/// Cells first..last, both included; empty when first > last.
struct CellRange {
  int first, last;
  int size() const { return last - first + 1; }
  bool operator==(const CellRange&) const = default;
};

/// Position of a cell along each axis.
using CellPosition = std::array<int, 3>;

/// n[0] * n[1] * n[2] cells, x fastest. An axis without extent has one cell of size 0.
class UniformCells {
 public:
  UniformCells() = default;
  /// @param box not empty  @param n at least 1 each
  UniformCells(const Aabb& box, const CellPosition& n) : n_(n) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t a = static_cast<std::size_t>(axis);
      const double extent = box.hi[axis] - box.lo[axis];
      lo_[a] = box.lo[axis];
      size_[a] = extent / n[a] * (1.0 + 8 * 0x1p-53);
      per_unit_[a] = size_[a] > 0.0 ? 1.0 / size_[a] : 0.0;
    }
  }

  int n(int axis) const { return n_[static_cast<std::size_t>(axis)]; }
  double plane(int axis, int i) const {
    const std::size_t a = static_cast<std::size_t>(axis);
    return lo_[a] + i * size_[a];
  }
  std::size_t count() const { return stride(2) * static_cast<std::size_t>(n_[2]); }
  /// Distance in memory of neighbours along the axis.
  std::size_t stride(int axis) const {
    const std::size_t nx = static_cast<std::size_t>(n_[0]);
    return axis == 0 ? 1 : axis == 1 ? nx : nx * static_cast<std::size_t>(n_[1]);
  }
  std::size_t index(const CellPosition& at) const {
    return static_cast<std::size_t>(at[0]) + stride(1) * static_cast<std::size_t>(at[1]) +
           stride(2) * static_cast<std::size_t>(at[2]);
  }
  CellPosition position(std::size_t index) const {
    const std::size_t nx = stride(1), ny = static_cast<std::size_t>(n_[1]);
    return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
            static_cast<int>(index / nx / ny)};
  }
  Aabb box(const CellPosition& at) const {
    return {{plane(0, at[0]), plane(1, at[1]), plane(2, at[2])},
            {plane(0, at[0] + 1), plane(1, at[1] + 1), plane(2, at[2] + 1)}};
  }

  /// A cell near x, at the border where x is outside or NaN; to be corrected against plane().
  int guess(int axis, double x) const {
    const std::size_t a = static_cast<std::size_t>(axis);
    const double i = (x - lo_[a]) * per_unit_[a];
    if (!(i > 0.0)) return 0;
    return i < n_[a] ? static_cast<int>(i) : n_[a] - 1;
  }

  /// The closed cells that [lo, hi] touches: one that merely ends or begins at a plane touches the
  /// cells on both sides of it. Empty where it lies outside. O(1): the guess is off by little.
  CellRange touched(int axis, double lo, double hi) const {
    CellRange range{guess(axis, lo), guess(axis, hi)};
    while (range.first > 0 && plane(axis, range.first) >= lo) --range.first;
    while (range.first < n(axis) && plane(axis, range.first + 1) < lo) ++range.first;
    while (range.last + 1 < n(axis) && plane(axis, range.last + 1) <= hi) ++range.last;
    while (range.last >= 0 && plane(axis, range.last) > hi) --range.last;
    return range;
  }

 private:
  CellPosition n_{1, 1, 1};
  std::array<double, 3> lo_{}, size_{}, per_unit_{};
};

}  // namespace strahl
