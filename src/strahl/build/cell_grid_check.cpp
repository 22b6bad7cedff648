// build/cell_grid_check.cpp - the invariants of a grid of cells, executable.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <strahl/build/cell_check.h>
#include <strahl/build/cell_grid.h>

namespace strahl {
namespace {

/// Looks every cell that a primitive's box touches up by comparing planes, without guesses.
class CellGridChecker {
 public:
  CellGridChecker(const CellGrid& grid, bool exact, const PrimitiveSource& source, const char* what)
      : cells_(grid.cells), lists_(grid.lists), is_exact_(exact), source_(source), what_(what) {}

  void run(const BuildReport& report) {
    check_lists();
    std::uint64_t found = 0;
    for (std::uint32_t i = 0; i < source_.size(); ++i) {
      const Aabb box = source_.bounds(i);
      if (!box.is_empty()) found += check_primitive(i, box);
    }
    // Counted from both sides, so no list refers to what is not in its cell or never hit.
    demand(found == lists_.references.size(), "a cell refers to what does not touch it");
    demand(report.leaves == cells_.count() && report.nodes == report.leaves, "report: cells");
    demand(report.references == found, "report: references");
    demand(report.empty_leaves == empty_, "report: empty cells");
  }

 private:
  void demand(bool holds, const char* broken) const {
    if (!holds) throw std::logic_error(std::string(what_) + ": " + broken);
  }

  void check_lists() {
    const std::vector<std::uint32_t>& first = lists_.first;
    demand(first.size() == cells_.count() + 1, "not one list per cell");
    demand(first.front() == 0 && first.back() == lists_.references.size(), "lists do not tile");
    for (std::size_t c = 0; c < cells_.count(); ++c) {
      demand(first[c] <= first[c + 1], "a list ends before it begins");
      const std::span<const std::uint32_t> list = lists_[c];
      empty_ += list.empty();
      demand(std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) == list.end(),
             "references of a cell do not ascend");
      demand(list.empty() || list.back() < source_.size(), "a reference is out of range");
    }
  }

  /// Number of cells that list the primitive; demands all that must.
  std::uint64_t check_primitive(std::uint32_t i, const Aabb& box) {
    CellRange range[3];
    for (int axis = 0; axis < 3; ++axis) {
      range[axis] = touched_by_planes(cells_, axis, box);
      demand(range[axis].size() > 0, "a primitive is outside the grid");
    }
    std::uint64_t found = 0;
    for (int z = range[2].first; z <= range[2].last; ++z)
      for (int y = range[1].first; y <= range[1].last; ++y)
        for (int x = range[0].first; x <= range[0].last; ++x) {
          const std::span<const std::uint32_t> list = lists_[cells_.index({x, y, z})];
          const bool is_listed = std::binary_search(list.begin(), list.end(), i);
          found += is_listed;
          if (!is_listed) demand_absent(source_, is_exact_, {box, i}, cells_.box({x, y, z}), what_);
        }
    demand(found > 0, "a primitive is in no cell");
    return found;
  }

  const UniformCells& cells_;
  const CellLists& lists_;
  bool is_exact_;
  const PrimitiveSource& source_;
  const char* what_;
  std::uint64_t empty_ = 0;
};

}  // namespace

CellRange touched_by_planes(const UniformCells& cells, int axis, const Aabb& box) {
  const auto count_planes = [&](auto is_before) {
    int low = 0, high = cells.n(axis) + 1;
    while (low < high) {
      const int middle = (low + high) / 2;
      if (is_before(cells.plane(axis, middle)))
        low = middle + 1;
      else
        high = middle;
    }
    return low;
  };
  const int before = count_planes([&](double p) { return p < box.lo[axis]; });
  const int up_to = count_planes([&](double p) { return p <= box.hi[axis]; });
  return {std::max(before - 1, 0), std::min(up_to - 1, cells.n(axis) - 1)};
}

/// Along axes on which the primitive reaches beyond the cell, a rim is left out in which bounds of
/// parts may be off by rounding.
void demand_absent(const PrimitiveSource& source, bool exact, const PrimRef& ref, const Aabb& cell,
                   const char* what) {
  const auto demand = [what](bool holds, const char* broken) {
    if (!holds) throw std::logic_error(std::string(what) + ": " + broken);
  };
  demand(exact, "a cell that a primitive's box touches does not list it");
  const double rim = 1024 * 0x1p-53 * std::max(norm_max(ref.box.lo), norm_max(ref.box.hi));
  Aabb core = cell;
  for (int axis = 0; axis < 3; ++axis) {
    if (ref.box.lo[axis] < cell.lo[axis]) core.lo[axis] += rim;
    if (ref.box.hi[axis] > cell.hi[axis]) core.hi[axis] -= rim;
  }
  if (core.is_empty()) return;
  demand(source.clip(ref.reference, core).is_empty(),
         "a cell that a primitive meets does not list it");
}

void check_cell_grid(const CellGrid& grid, const BuildReport& report, bool exact,
                     const PrimitiveSource& source, const char* what) {
  CellGridChecker(grid, exact, source, what).run(report);
}

}  // namespace strahl
