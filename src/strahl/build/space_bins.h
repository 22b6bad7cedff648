// build/space_bins.h - split planes at the borders of equal bins: min-max binning.
//
// Source: [Popov2006], [Shevtsov2007]. Lower ends are counted in the bin they lie in, upper ends
//   likewise; sums from either end give the exact counts at every border, for the plane as stored.
//   Only the set of positions is coarse, not their costs: between two borders each side keeps at
//   least what lies wholly beyond the other border, and no fragment is on neither side, which
//   bounds the cost of the planes that were not looked at.
// Thread safety: pure functions.
#pragma once

#include <span>

#include <strahl/base/executor.h>
#include <strahl/build/space_slices.h>

namespace strahl {

inline constexpr int kMaxSpaceBins = 1024;

/// A plane and what it may have missed.
struct BinnedPlane {
  SplitPlane plane;
  double least_cost = Aabb::kInf;  ///< no plane inside the cell costs less
};

/// The cheapest of the bins - 1 inner borders of each axis; is_found() is false when no border
/// lies strictly inside the cell. Ties: lowest axis, then position. O(n + bins).
/// @param bins 2..kMaxSpaceBins
BinnedPlane find_plane_by_bins(std::span<const Fragment> fragments, const PlaneCost& cost, int bins,
                               const Executor& executor);

/// The cheapest border of every slice. O(n + bins).
void offer_borders(std::span<const Fragment> fragments, int bins, PlaneSlices& slices,
                   const Executor& executor);

}  // namespace strahl
