// structures/wide_bvh/wide_compact.h - blocks of the compact layout: corners rounded to 16 bits.
//
// Source: numbers stored relative to the group they are in, as the boxes of
//   [YlitieKarrasLaine2017]; here corners, and the exact test makes up for what rounding loses.
// Layout: origin x, y, z as floats and a word, 16 bytes; a row of n references; nine rows of n
//   16-bit numbers (a.x, a.y, a.z, b.x, ...). A corner's coordinate is origin + step * number. The
//   word holds the exponent of step, a power of two, in its low 8 bits, and in the others the upper
//   bits of a float: a bound L of the lengths of the edges from corner a.
// Invariants: origin + step * number is a float for all numbers that are used (origin is a multiple
//   of step and both are below 2^24 steps), so the kernels need not agree on how it is rounded; it
//   is within kCompactError steps of the true corner. A block with a thing that is no triangle has
//   no corners: its step is infinite and its numbers are 0, so that each coordinate is NaN.
// Differs from the paper: one step for all axes, blocks of triangles instead of boxes.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include <strahl/geometry/primitive_source.h>
#include <strahl/structures/wide_bvh/wide_tree.h>

namespace strahl {

struct CompactHead {
  float origin[3];
  std::uint32_t word;

  float step() const { return std::bit_cast<float>((word & 0xffu) << 23); }
  float longest() const { return std::bit_cast<float>(word & ~0xffu); }
};
static_assert(sizeof(CompactHead) == sizeof(LeafBound));
static_assert(offsetof(CompactHead, word) == offsetof(LeafBound, is_compact));

/// In steps: half of one per axis, and what the frame rounds.
inline constexpr double kCompactError = 0.867;

inline const CompactHead& compact_head(const std::byte* leaf) {
  return *reinterpret_cast<const CompactHead*>(leaf);
}
/// That of a full block of these corners, or larger.
inline LeafBound compact_bound(const CompactHead& head) {
  // As leaf_bound() in wide_filter.cpp; 1.0003 for 1.0002 covers that these are floats.
  constexpr double kUnit = 0x1p-24;
  constexpr auto kPerDistance = static_cast<float>(1.0003 * 1.7321 * 18.6 * kUnit);
  constexpr auto kSquare = static_cast<float>(1.0003 * 23.6 * kUnit);
  constexpr auto kError = static_cast<float>(1.0003 * 10 * kCompactError);
  const float length = head.longest();
  return {-kPerDistance * length, -(kSquare * length + kError * head.step()) * length - 1.1e-30f,
          1.4001f * length, 0.0f};
}

/// Row r of a compact block.
inline const std::uint16_t* compact_row(const std::byte* leaf, std::uint32_t lanes,
                                        std::uint32_t row) {
  const std::byte* rows = leaf + sizeof(CompactHead) + 4 * lanes;
  return reinterpret_cast<const std::uint16_t*>(rows) + row * lanes;
}

/// Corners of a lane as stored, promoted.
TriangleVertices compact_corners(const std::byte* leaf, std::uint32_t lanes, std::uint32_t lane);

/// Writes head and rows of a block of these lanes, in the tree's frame.
void write_compact_block(std::byte* block, std::span<const std::uint32_t> references,
                         const WideFrame& frame, const PrimitiveSource& source);

}  // namespace strahl
