#include <algorithm>
#include <limits>

#include <strahl/build/fragment.h>

namespace strahl {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

enum class Side { left, right, both };

Side side_of(const Fragment& fragment, const SplitPlane& plane) {
  const float lo = fragment.lo[plane.axis], hi = fragment.hi[plane.axis];
  if (lo == plane.position && hi == plane.position)
    return plane.is_planar_left ? Side::left : Side::right;
  if (hi <= plane.position) return Side::left;
  if (lo >= plane.position) return Side::right;
  return Side::both;
}

void keep(FragmentHalf& half, const Fragment& fragment, std::size_t index, bool wants_places) {
  if (wants_places) half.place[index] = static_cast<std::uint32_t>(half.fragments.size());
  half.fragments.push_back(fragment);
}

void add_cut(FragmentHalf& half, Fragment fragment, const Aabb& box, const DivideRules& rules) {
  const Aabb part = rules.source ? rules.source->clip(fragment.reference, box) : box;
  if (!part.is_empty() && fragment.shrink_to(part)) half.fragments.push_back(fragment);
}

}  // namespace

bool Fragment::shrink_to(const Aabb& box) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    lo[axis] = std::max(lo[axis], float_below(box.lo[a]));
    hi[axis] = std::min(hi[axis], float_above(box.hi[a]));
    if (lo[axis] > hi[axis]) return false;
  }
  return true;
}

std::vector<Fragment> make_fragments(std::span<const PrimRef> refs) {
  std::vector<Fragment> fragments;
  fragments.reserve(refs.size());
  for (const PrimRef& ref : refs) {
    Fragment fragment{
        {-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}, ref.reference};
    fragment.shrink_to(ref.box);
    fragments.push_back(fragment);
  }
  return fragments;
}

Aabb below(const Aabb& cell, const SplitPlane& plane) {
  Aabb half = cell;
  half.hi[static_cast<int>(plane.axis)] = static_cast<double>(plane.position);
  return half;
}

Aabb above(const Aabb& cell, const SplitPlane& plane) {
  Aabb half = cell;
  half.lo[static_cast<int>(plane.axis)] = static_cast<double>(plane.position);
  return half;
}

FragmentHalves divide_fragments(std::span<const Fragment> fragments, const Aabb& cell,
                                const SplitPlane& plane, const DivideRules& rules) {
  FragmentHalves halves;
  halves.left.fragments.reserve(plane.left_count);
  halves.right.fragments.reserve(plane.right_count);
  if (rules.wants_places) {
    halves.left.place.assign(fragments.size(), FragmentHalf::kNowhere);
    halves.right.place.assign(fragments.size(), FragmentHalf::kNowhere);
  }
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    const Side side = side_of(fragments[i], plane);
    if (side == Side::left) keep(halves.left, fragments[i], i, rules.wants_places);
    if (side == Side::right) keep(halves.right, fragments[i], i, rules.wants_places);
  }
  halves.left.kept = halves.left.fragments.size();
  halves.right.kept = halves.right.fragments.size();
  const Aabb left_box = below(cell, plane), right_box = above(cell, plane);
  for (const Fragment& fragment : fragments) {
    if (side_of(fragment, plane) != Side::both) continue;
    add_cut(halves.left, fragment, left_box, rules);
    add_cut(halves.right, fragment, right_box, rules);
  }
  return halves;
}

}  // namespace strahl
