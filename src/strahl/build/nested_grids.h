// build/nested_grids.h - grids of equal cells whose cells may list further grids.
//
// Source: sub-grids of crowded cells [JevansWyvill1989]; lists as one array [LagaeDutre2008].
// Layout: all grids share one array of entries; the list of a grid's cell c is
//   entries[first[grid.first + c]] .. entries[first[grid.first + c + 1] - 1]. An entry is a
//   primitive or, with kGridEntry set, a grid; grids stand behind the primitives of a list.
// Invariants: lists of primitives are those of build/cell_lists.h, for the part of a primitive that
//   lies in the box of its grid. A cell with a sub-grid lists nothing else; the sub-grid divides
//   the cell's own box and lists, by the same rule, what the cell would. A grid's sub-grids follow
//   it. The words of all sub-grids, headers included, are at most max_growth per primitive.
// Differs from the paper: where grids would grow beyond the limit they are made coarser or left
//   out; with NestingDecision::cost a sub-grid must be expected to save work.
// Thread safety: read-only after the build.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <strahl/build/cell_grid.h>

namespace strahl {

enum class NestingDecision { cost, always };

/// What structures with sub-grids let a user choose about them.
struct NestingOptions {
  int max_prims = 8;
  int max_depth = 3;
  GridResolution sub_resolution = GridResolution::cubic;
  double sub_density = 4.0;
  int sub_n = 8;
  NestingDecision decide = NestingDecision::cost;
  double max_growth = 128.0;
};

inline constexpr int kMaxNesting = 16;

/// The rows of NestingOptions in the table of O, which is derived from it.
template <class O>
OptionTable<O> nesting_fields() {
  return {
      option<O>("max_prims", &O::max_prims, 1, 1000000, "primitives that never get a sub-grid"),
      option<O>("max_depth", &O::max_depth, 1, kMaxNesting, "grids within each other; 1: no more"),
      option<O, GridResolution>(
          "sub_resolution", &O::sub_resolution,
          {{"woo", GridResolution::woo},
           {"cubic", GridResolution::cubic},
           {"fixed", GridResolution::fixed}},
          "cells of sub-grids per axis: by the longest axis, as cubic as possible, or sub_n"),
      option<O>("sub_density", &O::sub_density, 0.001, 1000.0,
                "cells per primitive of sub-grids, not with fixed"),
      option<O>("sub_n", &O::sub_n, 1, 1024, "cells of sub-grids along each axis with fixed"),
      option<O, NestingDecision>(
          "decide", &O::decide,
          {{"cost", NestingDecision::cost}, {"always", NestingDecision::always}},
          "crowded cells get a sub-grid where that is expected to be cheaper, or always"),
      option<O>("max_growth", &O::max_growth, 0.0, 1000000.0,
                "words of sub-grids per primitive at most; cells share them by their contents"),
  };
}

/// 96 bytes.
struct NestedGrid {
  UniformCells cells;
  std::size_t first;  ///< of its cells in NestedGrids::first
};

struct NestedGrids {
  static constexpr std::uint32_t kGridEntry = 1u << 31;

  std::vector<NestedGrid> grids;
  std::vector<std::uint32_t> first;  ///< one more than cells for each grid
  std::vector<std::uint32_t> entries;

  static bool is_grid(std::uint32_t entry) { return (entry & kGridEntry) != 0; }
  static std::uint32_t grid_of(std::uint32_t entry) { return entry & ~kGridEntry; }

  const UniformCells& cells(std::uint32_t grid) const { return grids[grid].cells; }
  std::span<const std::uint32_t> list(std::uint32_t grid, std::size_t cell) const {
    const std::size_t at = grids[grid].first + cell;
    return {entries.data() + first[at], first[at + 1] - first[at]};
  }
  /// Of a list, without the grids.
  static std::span<const std::uint32_t> primitives(std::span<const std::uint32_t> list) {
    std::size_t count = list.size();
    while (count > 0 && is_grid(list[count - 1])) --count;
    return list.first(count);
  }
  Aabb box(std::uint32_t grid) const;
  std::uint64_t bytes() const;
  void shrink_to_fit() { grids.shrink_to_fit(), first.shrink_to_fit(), entries.shrink_to_fit(); }
  /// Adds grids that refer to none but themselves. Throws Error{resource} beyond 2^31 grids or 2^32
  /// entries, naming `what`.
  void append(const NestedGrids& more, const char* what);
};

/// Primitives whose number does not fit beside kGridEntry are an Error{resource}.
void require_entries(const PrimitiveSource& source, const char* what);

/// The primitives, clipped to the box; as boxes only unless exact.
std::vector<PrimRef> nested_parts(const PrimitiveSource& source, const Aabb& box,
                                  std::span<const std::uint32_t> list, bool exact);

/// What a grid is made of.
struct NestedGridInput {
  const PrimitiveSource& source;  ///< also of grids as objects, by their entries
  std::span<const PrimRef> refs;  ///< ascending
  bool exact = true;              ///< primitives decide, not their boxes
  std::uint64_t owned = 0;        ///< bytes that the caller holds, without refs and `out`
};

/// Appends a grid over the boxes of the refs, and sub-grids for its crowded cells, to `out`.
/// Deterministic for any executor. Throws Error{resource, cancelled}.
/// @param what names the structure in messages
/// @return the index of the grid
std::uint32_t add_nested_grid(const NestedGridInput& input, const CellGridOptions& options,
                              const NestingOptions& nesting, const BuildContext& context,
                              const char* what, NestedGrids& out);

/// Cells, references and cost of a grid and all in it; depth counts the grids around a cell but
/// one. A cell that lists a grid is no leaf. Bytes are those of all grids.
BuildReport report_of(const NestedGrids& grids, std::uint32_t grid = 0);

/// Words of 4 bytes in all grids but the given ones.
std::uint64_t sub_grid_words(const NestedGrids& grids, std::span<const std::uint32_t> outermost);

/// Expected cost of a random line that meets the grid, a cell or a test being 1.
double cost_of(const NestedGrids& grids, std::uint32_t grid);

void hash_into(Hash64& hash, const NestedGrids& grids);

/// Primitives in the cells of the grid and of those in it, ascending, each once.
std::vector<std::uint32_t> nested_contents(const NestedGrids& grids, std::uint32_t grid);

/// Throws std::logic_error naming the first broken invariant of the grid and all below it.
/// @param refs what it holds, ascending: primitives and, as an entry, grids that are placed in it
/// as
///   objects are  @param exact as built
void check_nested_grid(const NestedGrids& grids, std::uint32_t grid, std::span<const PrimRef> refs,
                       bool exact, const PrimitiveSource& source, const char* what);

/// Throws std::logic_error unless both count the same nodes, leaves and references.
void check_same_counts(const BuildReport& report, const BuildReport& counted, const char* what);

}  // namespace strahl
