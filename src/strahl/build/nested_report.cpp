// build/nested_report.cpp - what nested grids hold and what a ray is expected to pay in them.
#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include <strahl/build/nested_grids.h>
#include <strahl/build/sah.h>

namespace strahl {
namespace {

/// Grids that the lists of a grid name, each once.
std::vector<std::uint32_t> grids_in(const NestedGrids& grids, std::uint32_t grid) {
  std::vector<std::uint32_t> inner;
  for (std::size_t c = 0; c < grids.cells(grid).count(); ++c) {
    const auto list = grids.list(grid, c);
    for (const std::uint32_t entry : list.subspan(NestedGrids::primitives(list).size()))
      inner.push_back(NestedGrids::grid_of(entry));
  }
  std::sort(inner.begin(), inner.end());
  inner.erase(std::unique(inner.begin(), inner.end()), inner.end());
  return inner;
}

void add_grid(const NestedGrids& grids, std::uint32_t grid, std::uint64_t depth,
              BuildReport& report) {
  const std::size_t count = grids.cells(grid).count();
  report.nodes += count;
  report.depth = std::max(report.depth, depth);
  for (std::size_t c = 0; c < count; ++c) {
    const auto list = grids.list(grid, c);
    const std::size_t own = NestedGrids::primitives(list).size();
    report.references += own;
    report.leaves += own == list.size();
    report.empty_leaves += list.empty();
  }
  for (const std::uint32_t inner : grids_in(grids, grid)) add_grid(grids, inner, depth + 1, report);
}

}  // namespace

/// All cells of a grid are alike, so each is crossed with probability area(cell) / area(grid).
double cost_of(const NestedGrids& grids, std::uint32_t grid) {
  const UniformCells& cells = grids.cells(grid);
  const double area = grids.box(grid).half_area();
  double steps = static_cast<double>(cells.count());
  for (std::size_t c = 0; c < cells.count(); ++c)
    steps += static_cast<double>(NestedGrids::primitives(grids.list(grid, c)).size());
  double cost = steps * sah_share(cells.box({0, 0, 0}).half_area(), area);
  for (const std::uint32_t inner : grids_in(grids, grid))
    cost += std::min(1.0, sah_share(grids.box(inner).half_area(), area)) * cost_of(grids, inner);
  return cost;
}

std::uint64_t sub_grid_words(const NestedGrids& grids, std::span<const std::uint32_t> outermost) {
  constexpr std::size_t kHeader = sizeof(NestedGrid) / sizeof(std::uint32_t);
  std::uint64_t words = grids.grids.size() * kHeader + grids.first.size() + grids.entries.size();
  for (const std::uint32_t grid : outermost) {
    const std::size_t cells = grids.cells(grid).count();
    words -= kHeader + cells + 1;
    for (std::size_t c = 0; c < cells; ++c) words -= grids.list(grid, c).size();
  }
  return words;
}

BuildReport report_of(const NestedGrids& grids, std::uint32_t grid) {
  BuildReport report;
  add_grid(grids, grid, 0, report);
  report.bytes = grids.bytes();
  report.sah_cost = cost_of(grids, grid);
  return report;
}

void check_same_counts(const BuildReport& report, const BuildReport& counted, const char* what) {
  const auto counts = [](const BuildReport& r) {
    return std::array{r.nodes, r.leaves, r.empty_leaves, r.references, r.depth};
  };
  if (counts(report) != counts(counted))
    throw std::logic_error(std::string(what) + ": report: cells or references");
}

void hash_into(Hash64& hash, const NestedGrids& grids) {
  for (const NestedGrid& grid : grids.grids) hash_into(hash, grid.cells);
  hash.add(std::span<const std::uint32_t>(grids.first));
  hash.add(std::span<const std::uint32_t>(grids.entries));
}

}  // namespace strahl
