#include <algorithm>
#include <vector>

#include <strahl/build/space_median.h>
#include <strahl/build/space_naive.h>

namespace strahl {
namespace {

double middle_of(const Fragment& f, std::size_t axis) {
  return 0.5 * static_cast<double>(f.lo[axis]) + 0.5 * static_cast<double>(f.hi[axis]);
}

/// Counts the fragments about the plane; not found where that divides nothing.
SplitPlane judged(std::span<const Fragment> fragments, const PlaneCost& cost, std::size_t axis,
                  double position) {
  const float plane = float_below(position);
  const PlaneCounts counts = count_about(fragments, axis, plane);
  SplitPlane found;
  if (std::min(counts.left, counts.right) < fragments.size())
    cost.offer(axis, plane, counts, found);
  return found;
}

}  // namespace

SplitPlane find_plane_at_middle(std::span<const Fragment> fragments, const PlaneCost& cost,
                                std::size_t axis) {
  return judged(fragments, cost, axis, cost.cell().center()[static_cast<int>(axis)]);
}

SplitPlane find_plane_at_median(std::span<const Fragment> fragments, const PlaneCost& cost,
                                std::size_t axis) {
  if (fragments.empty()) return {};
  std::vector<double> middles;
  middles.reserve(fragments.size());
  for (const Fragment& f : fragments) middles.push_back(middle_of(f, axis));
  const auto median = middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2);
  std::nth_element(middles.begin(), median, middles.end());
  return judged(fragments, cost, axis, *median);
}

}  // namespace strahl
