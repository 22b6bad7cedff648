// build/grid_resolution.h - how many cells a grid gets along each axis.
//
// Source: rule woo after [Woo1992]; rule cubic after [Klimaszewski1994]: cells as cubic as
// possible. Differs from the paper: cubic first takes out, shortest first, every axis that is less
// than half
//   a cell long; its formulas would otherwise fail for flat and for stretched boxes.
// Thread safety: pure functions.
#pragma once

#include <cstdint>

#include <strahl/math/uniform_cells.h>

namespace strahl {

enum class GridRule {
  woo,   ///< L = cells^(1/3); n = floor(L * extent / longest extent): fewer cells in flat boxes
  cubic  ///< about `cells` cells, whatever the box's proportions
};

/// @param box not empty  @param cells wanted, at least 1
/// At least 1 per axis; at most about 4 * cells in all.
CellPosition grid_resolution(const Aabb& box, double cells, GridRule rule);

/// n lowered, the largest axis first, until no cell is thinner than a few units in the last place
/// of the box's coordinates and there are at most max_cells.
CellPosition limited_resolution(const Aabb& box, CellPosition n, std::uint64_t max_cells);

}  // namespace strahl
