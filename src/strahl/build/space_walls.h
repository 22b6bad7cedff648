// build/space_walls.h - split planes that triangles cover completely: walls between rooms.
//
// A rule for architectural scenes, from a lecture: a line that meets the plane ends there, so the
// far side is spared, which [MacDonaldBooth1990] does not count. The triangles within the plane go
// to the smaller side.
// Thread safety: pure functions.
#pragma once

#include <span>

#include <strahl/build/space_cost.h>

namespace strahl {

/// The cheapest plane strictly inside the cell whose whole cross-section is covered by triangles
/// within it; is_found() is false when there is none. Half of the lines that cross the plane would
/// go on to either side: the cost of that is taken off. Ties: lowest axis, then position.
/// O(n log n), and for every plane that enough triangles lie in O(triangles * pieces left open).
SplitPlane find_covered_plane(std::span<const Fragment> fragments, const PrimitiveSource& source,
                              const PlaneCost& cost);

}  // namespace strahl
