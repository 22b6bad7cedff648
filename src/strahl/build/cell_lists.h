// build/cell_lists.h - which primitives touch which cells of a grid, as one array of lists.
//
// Source: compact grids by two passes of counting [LagaeDutre2008].
// Layout: references of cell c are references[first[c]] .. references[first[c + 1] - 1].
// Invariants: a primitive is listed in every closed cell that a point of it lies in: all cells its
//   box touches or, with `exact`, those that the part of it between two planes of one axis, then
//   between two of a second one, touches along the third. The parts are bounded conservatively, and
//   a convex part meets every slab between its ends. Lists ascend and hold no reference twice.
// Thread safety: lists are read-only after the build.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/build/prim_ref.h>
#include <strahl/geometry/primitive_source.h>
#include <strahl/math/uniform_cells.h>

namespace strahl {

/// Compressed rows: 4 bytes per cell and per reference.
struct CellLists {
  std::vector<std::uint32_t> first;  ///< one more than cells
  std::vector<std::uint32_t> references;

  std::span<const std::uint32_t> operator[](std::size_t cell) const {
    return {references.data() + first[cell], first[cell + 1] - first[cell]};
  }
  std::uint64_t bytes() const {
    return (first.capacity() + references.capacity()) * sizeof(std::uint32_t);
  }
};

/// What fills the cells.
struct CellListInput {
  const PrimitiveSource& source;
  std::span<const PrimRef> refs;    ///< ascending by reference
  bool exact = true;                ///< the primitive decides, not its box
  std::uint64_t most = UINT32_MAX;  ///< references to be made at most, below 2^32
};

/// Empty when there would be more than input.most references. O(cells + references), each step a
/// clip if exact; twice the memory of the references. It is required from the context before it is
/// taken; the caller's own `owned` bytes count too.
std::optional<CellLists> make_cell_lists(const UniformCells& cells, const CellListInput& input,
                                         std::uint64_t owned, const BuildContext& context);

}  // namespace strahl
