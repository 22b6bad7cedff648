// structures/wide_bvh/wide_order.h - in which order a ray visits the slots of a node.
//
// Position p in a ray's order is slot p XOR order, where `order` holds the signs of the direction;
// so bit p of the ordered bits is bit p XOR order of the bits of the slots.
#pragma once

#include <array>
#include <cstdint>

namespace strahl {

namespace wide_detail {

using OrderTable = std::array<std::array<std::uint8_t, 256>, 8>;

constexpr OrderTable make_order_table() {
  OrderTable table{};
  for (std::uint32_t order = 0; order < 8; ++order)
    for (std::uint32_t bits = 0; bits < 256; ++bits)
      for (std::uint32_t p = 0; p < 8; ++p)
        table[order][bits] |= static_cast<std::uint8_t>((bits >> (p ^ order) & 1u) << p);
  return table;
}

inline constexpr OrderTable kOrderTable = make_order_table();

using SlotTable = std::array<std::array<std::uint64_t, 256>, 8>;

constexpr SlotTable make_slot_table() {
  SlotTable table{};
  for (std::uint32_t order = 0; order < 8; ++order)
    for (std::uint32_t bits = 0; bits < 256; ++bits) {
      std::uint32_t count = 0;
      std::uint64_t slots = 0, nearest = 0;
      for (std::uint32_t p = 8; p-- > 0;) {  // farthest first
        if ((bits >> (p ^ order) & 1u) == 0) continue;
        nearest = p ^ order;
        slots |= nearest << (8 * count++);
      }
      if (count < 8) slots |= nearest << 56;
      table[order][bits] = slots;
    }
  return table;
}

alignas(64) inline constexpr SlotTable kSlotTable = make_slot_table();

}  // namespace wide_detail

/// Bits of slots in a ray's order.
/// @param order the ray's signs, for 16 slots times 2
template <int W>
inline std::uint32_t visiting_order(std::uint32_t bits, std::uint32_t order) {
  const auto& table = wide_detail::kOrderTable[order & 7u];
  if constexpr (W == 8) return table[bits];
  const std::uint32_t halves = std::uint32_t{table[bits & 255u]} | std::uint32_t{table[bits >> 8]}
                                                                       << 8;
  return (halves | halves << 16) >> (order & 8u) & 0xffffu;  // rotated, without a branch
}

/// The order of wide_slots() that lists slots from the lowest.
inline constexpr std::uint32_t kAscendingSlots = 7;

/// The slots of `bits`, one per byte from the lowest, farthest first; the highest byte is the
/// nearest one.
inline const std::uint64_t& wide_slots(std::uint32_t bits, std::uint32_t order) {
  return wide_detail::kSlotTable[order][bits];
}

}  // namespace strahl
