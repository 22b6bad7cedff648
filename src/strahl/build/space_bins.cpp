#include <algorithm>
#include <array>
#include <vector>

#include <strahl/build/space_bins.h>

namespace strahl {
namespace {

/// The borders of one axis, ascending floats, each strictly inside the cell.
class Borders {
 public:
  Borders(const Aabb& cell, int axis, int bins) : lo_(cell.lo[axis]) {
    const double extent = cell.hi[axis] - lo_;
    scale_ = extent > 0.0 ? bins / extent : 0.0;
    for (int j = 1; j < bins; ++j) {
      const float p = float_below(lo_ + extent * j / bins);
      const bool is_new = at_.empty() || at_.back() < p;
      if (is_new && static_cast<double>(p) > lo_) at_.push_back(p);
    }
  }

  std::size_t size() const { return at_.size(); }
  float operator[](std::size_t i) const { return at_[i]; }
  /// Number of borders <= v.
  std::size_t count_up_to(float v) const {
    std::size_t k = guess(v);
    while (k > 0 && at_[k - 1] > v) --k;
    while (k < at_.size() && at_[k] <= v) ++k;
    return k;
  }
  /// Number of borders < v.
  std::size_t count_below(float v) const {
    std::size_t k = guess(v);
    while (k > 0 && at_[k - 1] >= v) --k;
    while (k < at_.size() && at_[k] < v) ++k;
    return k;
  }

 private:
  /// Nearly the number of borders below v; the loops above make it exact.
  std::size_t guess(float v) const {
    const double bin = (static_cast<double>(v) - lo_) * scale_;
    const double last = static_cast<double>(at_.size());
    return bin > 0.0 ? static_cast<std::size_t>(std::min(bin, last)) : 0;
  }

  double lo_, scale_;
  std::vector<float> at_;
};

/// How the fragments lie about every border of one axis.
std::vector<PlaneCounts> count_about_borders(std::span<const Fragment> fragments,
                                             const Borders& borders, std::size_t axis) {
  // starts[k]: fragments whose lower end has k borders at or below it; ends[k]: whose upper end has
  // k borders below it; planar[k]: fragments within border k, counted in neither.
  std::vector<std::size_t> starts(borders.size() + 1), ends(borders.size() + 1);
  std::vector<std::size_t> planar(borders.size());
  for (const Fragment& f : fragments) {
    const std::size_t start = borders.count_up_to(f.lo[axis]);
    if (f.is_planar(axis) && start > 0 && borders[start - 1] == f.lo[axis]) ++planar[start - 1];
    ++starts[start], ++ends[borders.count_below(f.hi[axis])];
  }
  std::vector<PlaneCounts> all;
  PlaneCounts counts{0, 0, fragments.size()};
  for (std::size_t k = 0; k < borders.size(); ++k) {
    counts.left += starts[k];  // lower end below border k
    counts.right -= ends[k];   // upper end at or below border k
    counts.planar = planar[k];
    all.push_back(counts);
  }
  return all;
}

/// No plane strictly between two positions costs less, if the sides hold at least `left` and
/// `right` of `all` fragments, each of which is on a side. Costs are linear in the position and
/// grow with the counts, so the least is at an end, what is left over all on one side.
double least_between(const PlaneCost& cost, std::size_t axis, double from, double to,
                     std::size_t left, std::size_t right, std::size_t all) {
  const std::size_t rest = all > left + right ? all - left - right : 0;
  double least = Aabb::kInf;
  for (const double at : {from, to})
    least = std::min(
        {least, cost.of(axis, at, left + rest, right), cost.of(axis, at, left, right + rest)});
  return least;
}

/// No plane off the borders of the axis costs less.
double least_off_borders(const PlaneCost& cost, std::size_t axis, const Borders& borders,
                         const std::vector<PlaneCounts>& counts, std::size_t all) {
  const int a = static_cast<int>(axis);
  double least = Aabb::kInf;
  double from = cost.cell().lo[a];
  std::size_t left = 0;
  for (std::size_t k = 0; k < borders.size(); ++k) {
    const auto to = static_cast<double>(borders[k]);
    const std::size_t right = counts[k].right + counts[k].planar;
    least = std::min(least, least_between(cost, axis, from, to, left, right, all));
    from = to, left = counts[k].left + counts[k].planar;
  }
  return std::min(least, least_between(cost, axis, from, cost.cell().hi[a], left, 0, all));
}

BinnedPlane best_border(std::span<const Fragment> fragments, const PlaneCost& cost,
                        std::size_t axis, int bins) {
  const Borders borders(cost.cell(), static_cast<int>(axis), bins);
  const std::vector<PlaneCounts> counts = count_about_borders(fragments, borders, axis);
  BinnedPlane best;
  for (std::size_t k = 0; k < borders.size(); ++k)
    cost.offer(axis, borders[k], counts[k], best.plane);
  best.least_cost =
      std::min(best.plane.cost, least_off_borders(cost, axis, borders, counts, fragments.size()));
  return best;
}

}  // namespace

BinnedPlane find_plane_by_bins(std::span<const Fragment> fragments, const PlaneCost& cost, int bins,
                               const Executor& executor) {
  std::array<BinnedPlane, 3> best;
  for_each_axis(executor, fragments.size(),
                [&](std::size_t axis) { best[axis] = best_border(fragments, cost, axis, bins); });
  BinnedPlane found{cheapest({best[0].plane, best[1].plane, best[2].plane}), Aabb::kInf};
  for (const BinnedPlane& one : best) found.least_cost = std::min(found.least_cost, one.least_cost);
  return found;
}

void offer_borders(std::span<const Fragment> fragments, int bins, PlaneSlices& slices,
                   const Executor& executor) {
  for_each_axis(executor, fragments.size(), [&](std::size_t axis) {
    const Borders borders(slices.cost().cell(), static_cast<int>(axis), bins);
    const std::vector<PlaneCounts> counts = count_about_borders(fragments, borders, axis);
    for (std::size_t k = 0; k < borders.size(); ++k) slices.offer(axis, borders[k], counts[k]);
  });
}

}  // namespace strahl
