#include <algorithm>

#include <strahl/structures/ternary_tree/oversize.h>

namespace strahl {
namespace {

Aabb box_of(const Fragment& f) {
  return {{f.lo[0], f.lo[1], f.lo[2]}, {f.hi[0], f.hi[1], f.hi[2]}};
}

/// Whether the box is long on two axes; an axis along which the cell is flat does not count.
bool has_long_sides(const Aabb& box, const Aabb& cell, double threshold) {
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double whole = cell.extent()[axis];
    axes += whole > 0.0 && box.extent()[axis] >= threshold * whole;
  }
  return axes >= 2;
}

double median_area(std::span<const Fragment> fragments) {
  std::vector<double> areas(fragments.size());
  std::transform(fragments.begin(), fragments.end(), areas.begin(),
                 [](const Fragment& f) { return box_of(f).half_area(); });
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  return *middle;
}

/// Area from which on a fragment is oversized.
double area_limit(std::span<const Fragment> fragments, const Aabb& cell,
                  const TernaryTreeOptions& options) {
  if (options.rule == OversizeRule::area) return options.threshold * cell.half_area();
  return options.median_factor * median_area(fragments);
}

}  // namespace

std::vector<bool> find_oversized(std::span<const Fragment> fragments, const Aabb& cell,
                                 const TernaryTreeOptions& options) {
  std::vector<bool> is_oversized(fragments.size());
  const bool by_sides = options.rule == OversizeRule::sides;
  const double limit = by_sides ? 0.0 : area_limit(fragments, cell, options);
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    const Aabb box = box_of(fragments[i]);
    is_oversized[i] =
        by_sides ? has_long_sides(box, cell, options.threshold) : box.half_area() >= limit;
  }
  return is_oversized;
}

}  // namespace strahl
