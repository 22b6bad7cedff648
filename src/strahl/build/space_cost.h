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
#include <cstdint>

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
      : cell_(cell), cost_(cost), empty_bonus_(empty_bonus) {
    const Vec3d e = cell.extent();
    const double whole = cell.half_area();
    const std::array<double, 3> areas{e.y * e.z, e.z * e.x, e.x * e.y};
    const std::array<double, 3> girths{e.y + e.z, e.z + e.x, e.x + e.y};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      crossing_[axis] = sah_share(areas[axis], whole);
      growth_[axis] = whole > 0.0 ? girths[axis] / whole : 0.0;
    }
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
    const Shares shares = shares_at(axis, static_cast<double>(position));
    const auto try_sides = [&](std::size_t left, std::size_t right, bool is_planar_left) {
      const double cost = of_counts(shares, left, right);
      if (cost < best.cost) best = {axis, position, is_planar_left, left, right, cost};
    };
    try_sides(counts.left + counts.planar, counts.right, true);
    if (counts.planar > 0) try_sides(counts.left, counts.right + counts.planar, false);
  }

  /// Cost of a plane with so many fragments on its sides, anywhere in the cell.
  double of(std::size_t axis, double position, std::size_t left, std::size_t right) const {
    return of_counts(shares_at(axis, position), left, right);
  }
  /// Cost of the plane where its sides cost `left` and `right` per line that crosses them.
  double of_sides(const SplitPlane& plane, double left, double right) const {
    const Shares shares = shares_at(plane.axis, static_cast<double>(plane.position));
    return sah_with_empty_bonus(of_parts(shares, left, right), empty_bonus_, plane.left_count,
                                plane.right_count);
  }
  /// Probability that a line in the cell crosses a plane perpendicular to the axis.
  double crossing(std::size_t axis) const { return crossing_[axis]; }
  const SahCost& sah() const { return cost_; }

 private:
  /// Probability that a line in the cell crosses the part below (above) a plane.
  struct Shares {
    double left, right;
  };
  Shares shares_at(std::size_t axis, double position) const {
    const int a = static_cast<int>(axis);
    const double least = crossing_[axis], growth = growth_[axis];
    return {least + (position - cell_.lo[a]) * growth, least + (cell_.hi[a] - position) * growth};
  }
  double of_parts(const Shares& shares, double left, double right) const {
    return cost_.traverse + shares.left * left + shares.right * right;
  }
  double of_counts(const Shares& shares, std::size_t left, std::size_t right) const {
    // Signed numbers become doubles in one instruction.
    const auto tests = [this](std::size_t count) {
      return cost_.intersect * static_cast<double>(static_cast<std::int64_t>(count));
    };
    return sah_with_empty_bonus(of_parts(shares, tests(left), tests(right)), empty_bonus_, left,
                                right);
  }

  Aabb cell_;
  SahCost cost_;
  double empty_bonus_;
  std::array<double, 3> crossing_, growth_;  ///< share of a part without length, and per length
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
