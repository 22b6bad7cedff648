#include <algorithm>
#include <span>

#include <strahl/base/error.h>
#include <strahl/build/grid_resolution.h>
#include <strahl/build/sah.h>
#include <strahl/structures/grid/grid.h>

namespace strahl {
namespace {

/// Where there would be more references than this per cell or primitive wanted, the grid is made
/// coarser: primitives are long compared with the cells, so that smaller cells do not part them.
/// Bounds work and memory.
constexpr double kMostReferences = 16;

CellPosition wanted_resolution(const Aabb& box, double cells, const GridOptions& options) {
  if (options.resolution == GridResolution::fixed) return {options.nx, options.ny, options.nz};
  const bool is_woo = options.resolution == GridResolution::woo;
  return grid_resolution(box, cells, is_woo ? GridRule::woo : GridRule::cubic);
}

}  // namespace

OptionTable<GridOptions> option_fields(const GridOptions*) {
  using O = GridOptions;
  return {
      option("resolution", &O::resolution,
             {{"woo", GridResolution::woo},
              {"cubic", GridResolution::cubic},
              {"fixed", GridResolution::fixed}},
             "cells per axis: by the longest axis, as cubic as possible, or nx, ny, nz"),
      option("density", &O::density, 0.001, 1000.0, "cells per primitive, not with fixed"),
      option("nx", &O::nx, 1, 1024, "cells along x with fixed"),
      option("ny", &O::ny, 1, 1024, "cells along y with fixed"),
      option("nz", &O::nz, 1, 1024, "cells along z with fixed"),
      option("exact", &O::exact, "list a triangle where it is, not where its box is"),
      option("mailbox", &O::mailbox, "remember which primitives a ray was tested against"),
      option("max_cells", &O::max_cells, 1, 1 << 30, "coarser where there would be more cells"),
  };
}

Grid::Grid(const PrimitiveSource& source, const Options& options, const BuildContext& context)
    : is_exact_(options.exact), has_mailbox_(options.mailbox) {
  const std::vector<PrimRef> refs = make_prim_refs(source, context);
  fill({source, refs, options.exact}, options, context);
  survey();
}

void Grid::fill(const CellListInput& given, const Options& options, const BuildContext& context) {
  CellListInput input = given;
  const auto count = static_cast<double>(input.refs.size());
  Aabb box;
  for (const PrimRef& ref : input.refs) box.extend(ref.box);
  if (box.is_empty()) box = {{}, {}};
  const bool is_fixed = options.resolution == GridResolution::fixed;
  const auto max_cells = static_cast<std::uint64_t>(options.max_cells);
  double wanted = std::max(1.0, options.density * count);
  const double most = kMostReferences * std::max(wanted, count);
  if (!is_fixed && most < UINT32_MAX) input.most = static_cast<std::uint64_t>(most);
  for (;; wanted /= 4) {
    const CellPosition n = wanted_resolution(box, wanted, options);
    cells_ = UniformCells(box, limited_resolution(box, n, max_cells));
    auto lists = make_cell_lists(cells_, input, input.refs.size_bytes(), context);
    if (lists) {
      lists_ = std::move(*lists);
      return;
    }
    if (is_fixed)
      throw Error(ErrorCode::resource, "more than 2^32 - 1 references in the cells", kName);
  }
}

/// Expected cost of a line that meets the box, a cell or a test being 1: all cells are alike, each
/// is crossed with probability area(cell) / area(box).
void Grid::survey() {
  const std::size_t count = cells_.count();
  const CellPosition last{cells_.n(0) - 1, cells_.n(1) - 1, cells_.n(2) - 1};
  const Aabb cell = cells_.box({0, 0, 0}), all = Aabb::join(cell, cells_.box(last));
  report_.nodes = report_.leaves = count;
  for (std::size_t i = 0; i < count; ++i) report_.empty_leaves += lists_[i].empty();
  report_.references = lists_.references.size();
  report_.bytes = lists_.bytes();
  report_.sah_cost = sah_share(cell.half_area(), all.half_area()) *
                     static_cast<double>(count + lists_.references.size());
}

void Grid::hash_into(Hash64& hash) const {
  for (int axis = 0; axis < 3; ++axis) {
    hash.add(cells_.n(axis));
    hash.add(cells_.plane(axis, 0)), hash.add(cells_.plane(axis, cells_.n(axis)));
  }
  hash.add(std::span<const std::uint32_t>(lists_.first));
  hash.add(std::span<const std::uint32_t>(lists_.references));
}

}  // namespace strahl
