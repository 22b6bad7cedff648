// Planes judged by what the planes behind them cost.
//
// A rule of a lecture, related to the temporary subtrees of [WodniokGoesele2016]: for two levels,
// C = traverse + P_L C(best plane of the left side) + P_R C(best plane of the right side), where
// the best planes are those of the surface area heuristic.
#include <algorithm>

#include <strahl/build/kd_policy.h>
#include <strahl/build/space_bins.h>

namespace strahl {
namespace {

/// Candidates per axis.
constexpr std::size_t kSlices = 4;

}  // namespace

SplitPlane KdPolicy::find_plane_ahead(CellWork& work) {
  SplitPlane best;
  for (SplitPlane plane : find_candidates(work)) {
    plane.cost = cost_ahead(work, plane, rules_.look_ahead);
    if (plane.cost < best.cost) best = plane;
  }
  return best;
}

/// The cheapest plane of every slice of every axis.
std::vector<SplitPlane> KdPolicy::find_candidates(CellWork& work) {
  const PlaneCost cost = cost_in(work.cell);
  PlaneSlices slices(cost, kSlices);
  if (is_binned(work)) {
    offer_borders(work.fragments, rules_.bins, slices, context_.executor);
  } else {
    sort_ends(work);
    offer_ends(work.events, work.fragments.size(), slices, context_.executor);
  }
  return slices.found();
}

/// Cost of a plane if its sides are divided on so many levels.
double KdPolicy::cost_ahead(const CellWork& work, const SplitPlane& plane, int levels) {
  if (levels == 0) return plane.cost;
  auto [left, right] = make_halves(work, plane);
  const double left_cost = least_cost_ahead(left, levels);
  const double right_cost = least_cost_ahead(right, levels);
  return cost_in(work.cell).of_sides(plane, left_cost, right_cost);
}

/// Cost of a cell that is left whole or divided at the cheapest plane.
double KdPolicy::least_cost_ahead(CellWork& work, int levels) {
  const double whole = sah_leaf_cost(rules_.cost, work.fragments.size());
  if (work.fragments.size() <= rules_.max_leaf) return whole;
  const SplitPlane plane = find_cheapest_plane(work);
  if (!plane.is_found()) return whole;
  return std::min(whole, cost_ahead(work, plane, levels - 1));
}

}  // namespace strahl
