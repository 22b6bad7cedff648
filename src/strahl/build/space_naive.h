// build/space_naive.h - split planes judged one by one: every end of every fragment, by counting
// all fragments about it.
//
// The first algorithm of [WaldHavran2006], O(n^2) per cell: what faster ones must agree with.
// Thread safety: pure functions.
#pragma once

#include <span>

#include <strahl/base/executor.h>
#include <strahl/build/space_cost.h>

namespace strahl {

/// How the fragments lie about a plane. O(n).
PlaneCounts count_about(std::span<const Fragment> fragments, std::size_t axis, float position);

/// What find_plane_by_sweep() finds. O(n^2).
SplitPlane find_plane_by_counting(std::span<const Fragment> fragments, const PlaneCost& cost,
                                  const Executor& executor);

}  // namespace strahl
