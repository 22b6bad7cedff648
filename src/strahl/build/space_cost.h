// build/space_cost.h - the surface area heuristic for planes that divide a cell.
//
// C(plane) = traverse + intersect * (A_L / A * N_L + A_R / A * N_R), [MacDonaldBooth1990], lowered
// where one side is empty. Fragments within the plane are counted on the cheaper side.
// Ties: the plane offered first stays, so offer by ascending axis, then position.
// Thread safety: immutable values.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <strahl/base/executor.h>
#include <strahl/build/fragment.h>
#include <strahl/build/sah.h>

namespace strahl {

/// How fragments lie about a plane; those the plane cuts count on both sides.
struct PlaneCounts {
  std::size_t left = 0, planar = 0, right = 0;
};

/// Judges planes of one cell.
class PlaneCost {
 public:
  PlaneCost(const Aabb& cell, const SahCost& cost, double empty_bonus)
      : cell_(cell), cost_(cost), empty_bonus_(empty_bonus), whole_(cell.half_area()) {
    const Vec3d e = cell.extent();
    cross_area_ = {e.y * e.z, e.z * e.x, e.x * e.y};
    cross_girth_ = {e.y + e.z, e.z + e.x, e.x + e.y};
  }

  const Aabb& cell() const { return cell_; }

  /// Whether the plane lies strictly inside the cell.
  bool is_inside(std::size_t axis, float position) const {
    const int a = static_cast<int>(axis);
    const double p = static_cast<double>(position);
    return cell_.lo[a] < p && p < cell_.hi[a];
  }

  /// Replaces best where the plane lies strictly inside the cell and is cheaper.
  void offer(std::size_t axis, float position, const PlaneCounts& counts, SplitPlane& best) const {
    if (!is_inside(axis, position)) return;
    const int a = static_cast<int>(axis);
    const double p = static_cast<double>(position);
    const double left_share = share(axis, p - cell_.lo[a]);
    const double right_share = share(axis, cell_.hi[a] - p);
    const auto try_sides = [&](std::size_t left, std::size_t right, bool is_planar_left) {
      const double cost = sah_with_empty_bonus(
          sah_split_cost(cost_, left_share, left, right_share, right), empty_bonus_, left, right);
      if (cost < best.cost) best = {axis, position, is_planar_left, left, right, cost};
    };
    try_sides(counts.left + counts.planar, counts.right, true);
    if (counts.planar > 0) try_sides(counts.left, counts.right + counts.planar, false);
  }

 private:
  double share(std::size_t axis, double length) const {
    return sah_share(cross_area_[axis] + length * cross_girth_[axis], whole_);
  }

  Aabb cell_;
  SahCost cost_;
  double empty_bonus_, whole_;
  std::array<double, 3> cross_area_, cross_girth_;
};

/// Calls work(axis) for the three axes, at once where there are many fragments.
template <class Work>
void for_each_axis(const Executor& executor, std::size_t fragments, Work work) {
  constexpr std::size_t kWorthTasks = std::size_t{1} << 14;
  const auto run = [&](std::size_t first, std::size_t last) {
    for (std::size_t axis = first; axis < last; ++axis) work(axis);
  };
  if (fragments < kWorthTasks)
    run(0, 3);
  else
    executor.parallel_for(0, 3, 1, run);
}

/// The cheapest plane, of the lowest axis on ties.
inline const SplitPlane& cheapest(const std::array<SplitPlane, 3>& planes) {
  return *std::min_element(
      planes.begin(), planes.end(),
      [](const SplitPlane& a, const SplitPlane& b) { return a.cost < b.cost; });
}

}  // namespace strahl
