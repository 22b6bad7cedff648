// build/nested_check.cpp - the invariants of nested grids, executable.
#include <algorithm>
#include <stdexcept>
#include <string>
#include <unordered_map>

#include <strahl/build/cell_check.h>
#include <strahl/build/nested_grids.h>

namespace strahl {
namespace {

/// One grid and what it should hold. Sub-grids get checkers of their own.
class NestedChecker {
 public:
  NestedChecker(const NestedGrids& grids, std::uint32_t grid, std::span<const PrimRef> refs,
                bool exact, const PrimitiveSource& source, const char* what)
      : grids_(grids), grid_(grid), refs_(refs), is_exact_(exact), source_(source), what_(what) {}

  void run() {
    check_lists();
    std::uint64_t listed = 0;
    for (const PrimRef& ref : refs_) listed += check_primitive(ref);
    // Counted from both sides, so no list names what is not in its cell.
    demand(listed == listed_, "a cell refers to what does not touch it");
  }

 private:
  void demand(bool holds, const char* broken) const {
    if (!holds) throw std::logic_error(std::string(what_) + ": " + broken);
  }
  const UniformCells& cells() const { return grids_.cells(grid_); }

  /// Whether the entry is among what the grid holds, not a sub-grid of a cell.
  bool is_held(std::uint32_t entry) const {
    const auto at = std::lower_bound(
        refs_.begin(), refs_.end(), entry,
        [](const PrimRef& ref, std::uint32_t value) { return ref.reference < value; });
    return at != refs_.end() && at->reference == entry;
  }
  /// A grid that divides the cell stands alone in its list.
  bool is_divided(std::span<const std::uint32_t> list) const {
    return list.size() == 1 && NestedGrids::is_grid(list[0]) && !is_held(list[0]);
  }

  void check_lists() {
    const NestedGrid& grid = grids_.grids[grid_];
    demand(grid.first + cells().count() < grids_.first.size(), "cells are out of range");
    for (std::size_t c = 0; c < cells().count(); ++c) {
      const std::size_t at = grid.first + c;
      demand(
          grids_.first[at] <= grids_.first[at + 1] && grids_.first[at + 1] <= grids_.entries.size(),
          "a list ends before it begins or is out of range");
      const auto list = grids_.list(grid_, c);
      demand(std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) == list.end(),
             "entries of a cell do not ascend");
      for (const std::uint32_t entry : list)
        demand(NestedGrids::is_grid(entry) ? NestedGrids::grid_of(entry) < grids_.grids.size()
                                           : entry < source_.size(),
               "an entry is out of range");
      if (is_divided(list))
        check_sub_grid(c, NestedGrids::grid_of(list[0]));
      else
        listed_ += list.size();
    }
  }

  /// It has the cell's planes and is right about what it holds; that this is enough is checked per
  /// primitive.
  void check_sub_grid(std::size_t cell, std::uint32_t sub) {
    demand(sub > grid_, "a sub-grid does not follow its grid");
    const UniformCells& inner = grids_.cells(sub);
    const CellPosition n{inner.n(0), inner.n(1), inner.n(2)};
    const Aabb box = cells().box(cells().position(cell));
    const UniformCells expected(box, n);
    for (int axis = 0; axis < 3; ++axis)
      for (const int i : {0, inner.n(axis)})
        demand(inner.plane(axis, i) == expected.plane(axis, i), "a sub-grid is not its cell");
    std::vector<std::uint32_t>& contents = contents_[cell];
    contents = nested_contents(grids_, sub);
    listed_ += contents.size();
    const std::vector<PrimRef> parts = nested_parts(source_, box, contents, is_exact_);
    NestedChecker(grids_, sub, parts, is_exact_, source_, what_).run();
  }

  /// Number of cells that list it or whose sub-grid does; demands all that must.
  std::uint64_t check_primitive(const PrimRef& ref) const {
    CellRange range[3];
    for (int axis = 0; axis < 3; ++axis) {
      range[axis] = touched_by_planes(cells(), axis, ref.box);
      demand(range[axis].size() > 0, "a primitive is outside the grid");
    }
    std::uint64_t found = 0;
    for (int z = range[2].first; z <= range[2].last; ++z)
      for (int y = range[1].first; y <= range[1].last; ++y)
        for (int x = range[0].first; x <= range[0].last; ++x) {
          const std::size_t cell = cells().index({x, y, z});
          const auto list = grids_.list(grid_, cell);
          if (std::binary_search(list.begin(), list.end(), ref.reference) ||
              is_in_sub_grid(cell, ref.reference))
            ++found;
          else
            demand_absent(source_, is_exact_, ref, cells().box({x, y, z}), what_);
        }
    demand(found > 0, "a primitive is in no cell");
    return found;
  }

  bool is_in_sub_grid(std::size_t cell, std::uint32_t reference) const {
    const auto sub = contents_.find(cell);
    return sub != contents_.end() &&
           std::binary_search(sub->second.begin(), sub->second.end(), reference);
  }

  const NestedGrids& grids_;
  std::uint32_t grid_;
  std::span<const PrimRef> refs_;
  bool is_exact_;
  const PrimitiveSource& source_;
  const char* what_;
  std::unordered_map<std::size_t, std::vector<std::uint32_t>> contents_;  ///< of divided cells
  std::uint64_t listed_ = 0;
};

void collect_primitives(const NestedGrids& grids, std::uint32_t grid,
                        std::vector<std::uint32_t>& found) {
  for (std::size_t c = 0; c < grids.cells(grid).count(); ++c) {
    const auto list = grids.list(grid, c);
    const auto own = NestedGrids::primitives(list);
    found.insert(found.end(), own.begin(), own.end());
    for (const std::uint32_t entry : list.subspan(own.size()))
      collect_primitives(grids, NestedGrids::grid_of(entry), found);
  }
}

}  // namespace

std::vector<std::uint32_t> nested_contents(const NestedGrids& grids, std::uint32_t grid) {
  std::vector<std::uint32_t> found;
  collect_primitives(grids, grid, found);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void check_nested_grid(const NestedGrids& grids, std::uint32_t grid, std::span<const PrimRef> refs,
                       bool exact, const PrimitiveSource& source, const char* what) {
  NestedChecker(grids, grid, refs, exact, source, what).run();
}

}  // namespace strahl
