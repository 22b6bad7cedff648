#include <algorithm>
#include <cmath>

#include <strahl/build/grid_resolution.h>

namespace strahl {
namespace {

/// Cells per axis are far below what an int holds, so that positions can be added and subtracted.
constexpr double kMostPerAxis = 0x1p28;

int whole_cells(double wanted) {
  return wanted >= 1.0 ? static_cast<int>(std::min(wanted, kMostPerAxis)) : 1;
}

CellPosition woo_resolution(const Vec3d& extent, double cells) {
  const double longest = norm_max(extent), most = std::cbrt(cells);
  CellPosition n{1, 1, 1};
  if (longest > 0.0)
    for (int axis = 0; axis < 3; ++axis)
      n[static_cast<std::size_t>(axis)] = whole_cells(extent[axis] / longest * most);
  return n;
}

/// Side of a cube or square or length of a segment of which `cells` fill the extents.
double cell_side(const std::array<double, 3>& extent, int axes, double cells) {
  // Roots are taken before products: extents may be as large as 2^241.
  double side = 1.0;
  for (int k = 0; k < axes; ++k) side *= std::pow(extent[static_cast<std::size_t>(k)], 1.0 / axes);
  return side / std::pow(cells, 1.0 / axes);
}

CellPosition cubic_resolution(const Vec3d& extent, double cells) {
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return extent[a] > extent[b]; });
  std::array<double, 3> sorted;
  for (std::size_t k = 0; k < 3; ++k) sorted[k] = extent[order[k]];
  const auto is_flat = [&](int axes) {
    const double shortest = sorted[static_cast<std::size_t>(axes) - 1];
    return !(shortest > 0.0 && shortest >= 0.5 * cell_side(sorted, axes, cells));
  };
  int axes = 3;
  while (axes > 0 && is_flat(axes)) --axes;
  CellPosition n{1, 1, 1};
  double left = cells;
  for (std::size_t k = 0; axes > 0; ++k, --axes) {
    std::array<double, 3> rest{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(axes); ++i) rest[i] = sorted[k + i];
    const int count = whole_cells(std::round(rest[0] / cell_side(rest, axes, left)));
    n[static_cast<std::size_t>(order[k])] = count;
    left = std::max(1.0, left / count);
  }
  return n;
}

}  // namespace

CellPosition grid_resolution(const Aabb& box, double cells, GridRule rule) {
  const Vec3d extent = box.extent();
  return rule == GridRule::woo ? woo_resolution(extent, cells) : cubic_resolution(extent, cells);
}

CellPosition limited_resolution(const Aabb& box, CellPosition n, std::uint64_t max_cells) {
  constexpr double kThinnest = 16 * 0x1p-52;
  for (int axis = 0; axis < 3; ++axis) {
    const double largest = std::max(std::abs(box.lo[axis]), std::abs(box.hi[axis]));
    const double most = largest > 0.0 ? box.extent()[axis] / (kThinnest * largest) : 1.0;
    int& count = n[static_cast<std::size_t>(axis)];
    count = std::min(count, whole_cells(most));
  }
  const auto others = [&](std::size_t axis) {
    return static_cast<std::uint64_t>(n[(axis + 1) % 3]) *
           static_cast<std::uint64_t>(n[(axis + 2) % 3]);
  };
  for (;;) {
    const auto longest = static_cast<std::size_t>(std::max_element(n.begin(), n.end()) - n.begin());
    if (static_cast<std::uint64_t>(n[longest]) * others(longest) <= max_cells) return n;
    n[longest] /= 2;
  }
}

}  // namespace strahl
