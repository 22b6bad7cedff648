// build/space_empty.h - split planes that cut off empty space, before any other plane is looked at.
//
// A rule of a lecture; by the analysis in [MacDonaldBooth1990] the border of the content is the
// best plane where the content is even and fills at most a third of the side.
// Thread safety: pure functions.
#pragma once

#include <span>

#include <strahl/build/space_cost.h>

namespace strahl {

/// The plane at the border of what the cell holds, towards the side with the most empty space as a
/// part of the cell's extent; is_found() is false when that is less than `least` or there is no
/// fragment. Ties: lowest axis, then the lower side. O(n).
SplitPlane find_empty_cut(std::span<const Fragment> fragments, const PlaneCost& cost, double least);

}  // namespace strahl
