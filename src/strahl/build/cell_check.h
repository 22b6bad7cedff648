// build/cell_check.h - whether cells list what they must, told without the builders' arithmetic.
//
// Thread safety: pure functions.
#pragma once

#include <strahl/build/prim_ref.h>
#include <strahl/math/uniform_cells.h>

namespace strahl {

/// First and last closed cell that the box touches, by bisection over the planes: no guesses.
CellRange touched_by_planes(const UniformCells& cells, int axis, const Aabb& box);

/// Throws std::logic_error unless the primitive, not listed in a cell that its box touches, may be
/// missing there. @param exact as built  @param what the structure, for messages
void demand_absent(const PrimitiveSource& source, bool exact, const PrimRef& ref, const Aabb& cell,
                   const char* what);

}  // namespace strahl
