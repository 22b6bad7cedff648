#include <algorithm>

#include <strahl/base/error.h>
#include <strahl/build/cell_grid.h>
#include <strahl/build/grid_resolution.h>
#include <strahl/build/sah.h>

namespace strahl {
namespace {

/// Where there would be more references than this per cell or primitive wanted, the grid is made
/// coarser: primitives are long compared with the cells, so that smaller cells do not part them.
/// Bounds work and memory.
constexpr double kMostReferences = 16;

CellPosition wanted_resolution(const Aabb& box, double cells, const CellGridOptions& options) {
  if (options.resolution == GridResolution::fixed) return {options.nx, options.ny, options.nz};
  const bool is_woo = options.resolution == GridResolution::woo;
  return grid_resolution(box, cells, is_woo ? GridRule::woo : GridRule::cubic);
}

}  // namespace

std::optional<CellGrid> fit_cell_grid(CellListInput input, const Aabb& box,
                                      const CellGridOptions& options, std::uint64_t owned,
                                      const BuildContext& context) {
  const auto count = static_cast<double>(input.refs.size());
  const bool is_fixed = options.resolution == GridResolution::fixed;
  const auto max_cells = static_cast<std::uint64_t>(options.max_cells);
  double wanted = std::max(1.0, options.density * count);
  const double useful = kMostReferences * std::max(wanted, count);
  if (!is_fixed && useful < static_cast<double>(input.most))
    input.most = static_cast<std::uint64_t>(useful);
  for (;; wanted /= 4) {
    const CellPosition n = wanted_resolution(box, wanted, options);
    const UniformCells cells(box, limited_resolution(box, n, max_cells));
    auto lists = make_cell_lists(cells, input, owned + input.refs.size_bytes(), context);
    if (lists) return CellGrid{cells, std::move(*lists)};
    if (is_fixed || cells.count() == 1) return std::nullopt;
  }
}

CellGrid make_cell_grid(const PrimitiveSource& source, const CellGridOptions& options,
                        std::uint64_t most, const char* what, const BuildContext& context) {
  const std::vector<PrimRef> refs = make_prim_refs(source, context);
  Aabb box;
  for (const PrimRef& ref : refs) box.extend(ref.box);
  if (box.is_empty()) box = {{}, {}};
  auto grid = fit_cell_grid({source, refs, options.exact, most}, box, options, 0, context);
  if (grid) return std::move(*grid);
  throw Error(ErrorCode::resource, "more than " + std::to_string(most) + " references in the cells",
              what);
}

/// Expected cost of a line that meets the box, a cell or a test being 1: all cells are alike, each
/// is crossed with probability area(cell) / area(box).
BuildReport report_of(const CellGrid& grid) {
  const auto& [cells, lists] = grid;
  const std::size_t count = cells.count();
  const CellPosition last{cells.n(0) - 1, cells.n(1) - 1, cells.n(2) - 1};
  const Aabb cell = cells.box({0, 0, 0}), all = Aabb::join(cell, cells.box(last));
  BuildReport report;
  report.nodes = report.leaves = count;
  for (std::size_t i = 0; i < count; ++i) report.empty_leaves += lists[i].empty();
  report.references = lists.references.size();
  report.bytes = lists.bytes();
  report.sah_cost = sah_share(cell.half_area(), all.half_area()) *
                    static_cast<double>(count + lists.references.size());
  return report;
}

void hash_into(Hash64& hash, const UniformCells& cells) {
  for (int axis = 0; axis < 3; ++axis) {
    hash.add(cells.n(axis));
    hash.add(cells.plane(axis, 0)), hash.add(cells.plane(axis, cells.n(axis)));
  }
}

}  // namespace strahl
