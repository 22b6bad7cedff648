#include <algorithm>

#include <strahl/build/sort_few.h>
#include <strahl/structures/wide_bvh/wide_any_order.h>

namespace strahl {
namespace {

/// Of a child, 0 where nothing is; the larger, the earlier it is visited. The square of the chance
/// over the root of the cost orders alike.
float promise(const Blocking& child) {
  if (!(child.triangle_area > 0.0)) return 0.0f;
  const double chance = child.triangle_area / (child.triangle_area + child.half_area);
  return static_cast<float>(chance * chance / child.cost);
}

}  // namespace

std::array<std::uint32_t, kOrderedWidth> any_order(
    std::span<const Blocking, kOrderedWidth> children) {
  std::array<std::uint32_t, kOrderedWidth>
      order;  // floats that are not negative sort by their bits
  for (std::uint32_t slot = 0; slot < kOrderedWidth; ++slot)
    order[slot] = (std::bit_cast<std::uint32_t>(promise(children[slot])) & ~kOrderMask) | slot;
  sort_few(std::span(order));
  for (std::uint32_t& slot : order) slot &= kOrderMask;
  return order;
}

}  // namespace strahl
