// structures/wide_bvh/wide_any_order.h - in which order rays that ask for any hit visit the
// children of a node of 16: first where a hit is likely and little work is lost if there is none.
//
// Source: [NahManocha2014] (the cost of a subtree whose rays end at their first hit); here the
//   children of a node fall by p / sqrt(c), p = a / (a + b) the chance that a line through the
//   child's box meets a triangle, c the cost of its subtree; a and b are the areas of the triangles
//   and of half the box, seen along the axes.
// Layout: the low 4 bits of lane i of a node's row of low x planes are the slot that is visited
//   i-th, counted from the last. So the order costs no memory and comes with a row that the test of
//   boxes loads anyway. A plane moves outward by at most 15 units in its last place.
// Invariants: the slots of a node are a permutation; a plane is not above the one it stands for.
// Differs from the paper: an order per node instead of a choice between two children; no ray's
//   length. Kernels that cannot permute 16 lanes at once keep the order of first hits.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace strahl {

inline constexpr std::uint32_t kOrderMask = 15;
inline constexpr std::size_t kOrderedWidth = 16;

/// What is known of the subtree of a child.
struct Blocking {
  double triangle_area = 0.0;  ///< seen along x, y and z, summed; 0: none is in the slot
  double half_area = 0.0;      ///< of its box, which is the same
  double cost = 1.0;           ///< of a line that meets the box, in node steps
};

/// The slot in the low bits of a plane.
inline std::uint32_t ordered_slot(float plane) {
  return std::bit_cast<std::uint32_t>(plane) & kOrderMask;
}

/// The greatest float not above `plane` with that slot in its low bits. +inf stays above all
/// planes.
inline float with_ordered_slot(float plane, std::uint32_t slot) {
  const auto bits = std::bit_cast<std::uint32_t>(plane), near = (bits & ~kOrderMask) | slot;
  std::uint32_t below = near;
  if (bits >> 31 != 0)
    below = near < bits ? near + kOrderMask + 1 : near;
  else if (near > bits)
    below = bits > kOrderMask ? near - kOrderMask - 1 : 0x80000000u | slot;
  return std::bit_cast<float>(below);
}

/// Slots in the order of visit, counted from the last; those without triangles come first.
std::array<std::uint32_t, kOrderedWidth> any_order(
    std::span<const Blocking, kOrderedWidth> children);

}  // namespace strahl
