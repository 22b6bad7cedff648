#include <strahl/build/space_naive.h>

namespace strahl {
namespace {

/// Planes come in any order here: the lowest position wins among the cheapest.
bool is_better(const SplitPlane& plane, const SplitPlane& best) {
  return plane.cost < best.cost || (plane.cost == best.cost && plane.position < best.position);
}

SplitPlane best_counted(std::span<const Fragment> fragments, const PlaneCost& cost,
                        std::size_t axis) {
  SplitPlane best;
  for (const Fragment& f : fragments)
    for (const float end : {f.lo[axis], f.hi[axis]}) {
      if (!cost.is_inside(axis, end)) continue;
      SplitPlane plane;
      cost.offer(axis, end, count_about(fragments, axis, end), plane);
      if (plane.is_found() && is_better(plane, best)) best = plane;
    }
  return best;
}

}  // namespace

PlaneCounts count_about(std::span<const Fragment> fragments, std::size_t axis, float position) {
  PlaneCounts counts;
  for (const Fragment& f : fragments) {
    const bool is_within = f.lo[axis] == position && f.hi[axis] == position;
    counts.planar += is_within;
    counts.left += !is_within && f.lo[axis] < position;
    counts.right += !is_within && f.hi[axis] > position;
  }
  return counts;
}

SplitPlane find_plane_by_counting(std::span<const Fragment> fragments, const PlaneCost& cost,
                                  const Executor& executor) {
  std::array<SplitPlane, 3> best;
  for_each_axis(executor, fragments.size(),
                [&](std::size_t axis) { best[axis] = best_counted(fragments, cost, axis); });
  return cheapest(best);
}

}  // namespace strahl
