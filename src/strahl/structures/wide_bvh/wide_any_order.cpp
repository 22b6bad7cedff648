#include <algorithm>
#include <cmath>
#include <numeric>

#include <strahl/structures/wide_bvh/wide_any_order.h>

namespace strahl {
namespace {

/// Of a child; the larger, the earlier it is visited.
double promise(const Blocking& child) {
  if (child.half_area < 0.0) return -1.0;
  const double chance = -std::expm1(-child.triangle_area / child.half_area);
  return chance > 0.0 ? chance / std::sqrt(child.cost) : 0.0;  // NaN: 0 of 0
}

}  // namespace

std::array<std::uint32_t, kOrderedWidth> any_order(
    std::span<const Blocking, kOrderedWidth> children) {
  std::array<double, kOrderedWidth> promises;
  std::transform(children.begin(), children.end(), promises.begin(), promise);
  std::array<std::uint32_t, kOrderedWidth> order;
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return promises[a] != promises[b] ? promises[a] < promises[b] : a < b;
  });
  return order;
}

}  // namespace strahl
