#include <algorithm>
#include <array>
#include <limits>

#include <strahl/build/space_empty.h>

namespace strahl {
namespace {

/// What the fragments fill, per axis.
struct Content {
  static constexpr float kMost = std::numeric_limits<float>::infinity();
  std::array<float, 3> lo{kMost, kMost, kMost}, hi{-kMost, -kMost, -kMost};

  explicit Content(std::span<const Fragment> fragments) {
    for (const Fragment& f : fragments)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        lo[axis] = std::min(lo[axis], f.lo[axis]);
        hi[axis] = std::max(hi[axis], f.hi[axis]);
      }
  }
};

}  // namespace

SplitPlane find_empty_cut(std::span<const Fragment> fragments, const PlaneCost& cost,
                          double least) {
  SplitPlane best;
  if (fragments.empty()) return best;
  const Content content(fragments);
  const std::size_t count = fragments.size();
  double widest = 0.0;
  const auto offer = [&](std::size_t axis, float position, double gap, bool is_low) {
    const double part = gap / cost.cell().extent()[static_cast<int>(axis)];
    if (!(part >= least && part > widest) || !cost.is_inside(axis, position)) return;
    widest = part;
    best = {axis, position, !is_low, is_low ? 0 : count, is_low ? count : 0, 0.0};
    best.cost = cost.of(axis, static_cast<double>(position), best.left_count, best.right_count);
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    const float lo = content.lo[axis], hi = content.hi[axis];
    offer(axis, lo, static_cast<double>(lo) - cost.cell().lo[a], true);
    offer(axis, hi, cost.cell().hi[a] - static_cast<double>(hi), false);
  }
  return best;
}

}  // namespace strahl
