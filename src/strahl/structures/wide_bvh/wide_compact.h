// structures/wide_bvh/wide_compact.h - blocks of the compact layout: each distinct corner once, or
// corners rounded to 16 bits.
//
// Source: numbers stored relative to the group they are in, as the boxes of
//   [YlitieKarrasLaine2017]; here corners, and the exact test makes up for what rounding loses.
// Layout: a head of 16 bytes whose last word is not 0, a row of n references, and
//   indexed: the error bounds of a full block, a word of 256 m; three rows of m floats, the x, y
//   and
//     z of m corners that differ in their bits; three rows of n bytes, which of them a, b, c are;
//   rounded: origin x, y, z, a word; nine rows of n 16-bit numbers (a.x, a.y, a.z, b.x, ...). A
//     coordinate is origin + step * number. The word's low 8 bits are the exponent of step, a power
//     of two, the others those of a float: a bound of the lengths of the edges from corner a.
// A block is indexed where that is small enough (BlockSizes), so meshes keep their very corners
//   and triangles that share nothing are rounded.
// Invariants: origin + step * number is a float for all numbers that are used (origin is a multiple
//   of step and both are below 2^24 steps), so it does not matter how the sum is rounded; it is
//   within kCompactError steps of the true corner. A rounded block with a thing that is no triangle
//   has no corners: its step is infinite and its numbers are 0, so that each coordinate is NaN.
// Differs from the paper: one step for all axes, blocks of triangles instead of boxes.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <strahl/geometry/mesh.h>
#include <strahl/structures/wide_bvh/wide_filter.h>
#include <strahl/structures/wide_bvh/wide_tree.h>

namespace strahl {

/// In steps: half of one per axis, and what the frame rounds.
inline constexpr double kCompactError = 0.867;
/// Most distinct corners of an indexed block.
inline constexpr std::uint32_t kMostDistinct = 32;

struct RoundedHead {
  float origin[3];
  std::uint32_t word;

  float step() const { return std::bit_cast<float>((word & 0xffu) << 23); }
  float longest() const { return std::bit_cast<float>(word & ~0xffu); }
};
static_assert(sizeof(RoundedHead) == sizeof(LeafBound));
static_assert(offsetof(RoundedHead, word) == offsetof(LeafBound, word));

inline const RoundedHead& rounded_head(const std::byte* leaf) {
  return *reinterpret_cast<const RoundedHead*>(leaf);
}
/// Of an indexed block.
inline std::uint32_t distinct_of(const std::byte* leaf) { return leaf_word(leaf) >> 8; }

constexpr std::size_t rounded_bytes(std::size_t lanes) { return sizeof(RoundedHead) + 22 * lanes; }
constexpr std::size_t indexed_bytes(std::size_t lanes, std::size_t distinct) {
  return sizeof(LeafBound) + 7 * lanes + 12 * distinct;
}

/// Row r (x, y, z) of the corners of an indexed block.
inline const float* distinct_row(const std::byte* leaf, std::uint32_t lanes, std::uint32_t row) {
  const auto* rows = reinterpret_cast<const float*>(leaf + sizeof(LeafBound) + 4 * lanes);
  return rows + row * distinct_of(leaf);
}
/// Row c (a, b, c) of which corner of an indexed block is whose.
inline const std::uint8_t* index_row(const std::byte* leaf, std::uint32_t lanes,
                                     std::uint32_t row) {
  return reinterpret_cast<const std::uint8_t*>(distinct_row(leaf, lanes, 3)) + row * lanes;
}
/// Row r of a rounded block.
inline const std::uint16_t* rounded_row(const std::byte* leaf, std::uint32_t lanes,
                                        std::uint32_t row) {
  const std::byte* rows = leaf + sizeof(RoundedHead) + 4 * lanes;
  return reinterpret_cast<const std::uint16_t*>(rows) + row * lanes;
}

/// The bounds of a rounded block: those of a full one of these corners, or larger.
inline LeafBound rounded_bound(const RoundedHead& head) {
  // As leaf_bound() in wide_filter.cpp; 1.0003 for 1.0002 covers that these are floats.
  constexpr double kUnit = 0x1p-24;
  constexpr auto kPerDistance = static_cast<float>(1.0003 * 1.7321 * 18.6 * kUnit);
  constexpr auto kSquare = static_cast<float>(1.0003 * 23.6 * kUnit);
  constexpr auto kError = static_cast<float>(1.0003 * 10 * kCompactError);
  const float length = head.longest();
  return {-kPerDistance * length, -(kSquare * length + kError * head.step()) * length - 1.1e-30f,
          1.4001f * length, 0};
}

/// Corners of a lane of a compact block as stored, promoted.
TriangleVertices compact_corners(const std::byte* leaf, std::uint32_t lanes, std::uint32_t lane);

/// The things of a block: their corners as a full block holds them (NaN: no triangle), and those
/// before they were rounded to floats.
struct BlockCorners {
  std::uint32_t lanes = 0;
  bool all_triangles = true;
  std::array<LaneCorners, kWideMaxLanes> stored;
  std::array<TriangleVertices, kWideMaxLanes> in_frame;
};

/// Bytes of a block, one way or the other.
struct BlockSizes {
  std::size_t indexed, rounded;

  /// @param spare units that it may take beyond rounded to keep its very corners
  std::size_t bytes(std::uint64_t spare) const {
    const auto size = [](std::size_t bytes) { return units(bytes, WideLayout::compact); };
    return size(indexed) <= size(rounded) + spare ? indexed : rounded;
  }
};
BlockSizes compact_sizes(const BlockCorners& corners);
/// Of a block that is written.
std::size_t compact_bytes(const std::byte* leaf, std::uint32_t lanes);

/// Writes all but the references of a block.
/// @return whether it fits into that many bytes; if not, nothing is written
bool write_compact_block(std::byte* block, const BlockCorners& corners, std::size_t bytes);

}  // namespace strahl
