// build/space_median.h - split planes in the middle of a cell or of its fragments, costs unseen.
//
// Source: [Kaplan1985] (spatial middle); object median after [Bentley1975].
// Thread safety: pure functions.
#pragma once

#include <span>

#include <strahl/build/space_cost.h>

namespace strahl {

/// The plane through the middle of the cell. is_found() is false where no float lies strictly
/// inside the cell or the plane would leave every fragment on both sides. O(n).
SplitPlane find_plane_at_middle(std::span<const Fragment> fragments, const PlaneCost& cost,
                                std::size_t axis);

/// The plane through the median of the fragments' middles; is_found() as above. O(n).
SplitPlane find_plane_at_median(std::span<const Fragment> fragments, const PlaneCost& cost,
                                std::size_t axis);

}  // namespace strahl
