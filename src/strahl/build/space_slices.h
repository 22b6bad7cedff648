// build/space_slices.h - the cheapest plane of every slice of a cell: candidates that are cheap and
// far from each other.
//
// Invariant: the cheapest plane of the cell is among them, first among equals.
// Thread safety: the slices of different axes may be filled at once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

#include <strahl/build/space_cost.h>

namespace strahl {

/// Each axis of a cell in equal parts.
class PlaneSlices {
 public:
  PlaneSlices(const PlaneCost& cost, std::size_t per_axis)
      : cost_(cost), per_axis_(per_axis), best_(3 * per_axis) {}

  const PlaneCost& cost() const { return cost_; }

  /// Planes of one axis ascending.
  void offer(std::size_t axis, float position, const PlaneCounts& counts) {
    if (cost_.is_inside(axis, position))
      cost_.offer(axis, position, counts, best_[axis * per_axis_ + slice_of(axis, position)]);
  }

  /// By axis, then position.
  std::vector<SplitPlane> found() const {
    std::vector<SplitPlane> planes;
    std::copy_if(best_.begin(), best_.end(), std::back_inserter(planes),
                 [](const SplitPlane& plane) { return plane.is_found(); });
    return planes;
  }

 private:
  /// Requires: strictly inside the cell.
  std::size_t slice_of(std::size_t axis, float position) const {
    const int a = static_cast<int>(axis);
    const double from = static_cast<double>(position) - cost_.cell().lo[a];
    const double slice = from / cost_.cell().extent()[a] * static_cast<double>(per_axis_);
    return std::min(static_cast<std::size_t>(slice), per_axis_ - 1);
  }

  const PlaneCost& cost_;
  std::size_t per_axis_;
  std::vector<SplitPlane> best_;
};

}  // namespace strahl
