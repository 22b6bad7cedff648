// structures/wide_bvh/wide_tree.h - nodes and leaf blocks of the wide tree, as the kernels read
// them.
//
// Layout: one arena. A wide node of W = 8 or 16 slots is six rows of W floats (low x, y, z, then
//   high x, y, z) and a row of W child ids, 28 W bytes. A leaf block of n triangles is a LeafBound,
//   nine rows of n floats (corner a's x, y, z, then b's and c's) and a row of n references,
//   16 + 40 n bytes. Rows are read with full vectors from their unaligned beginning; lanes beyond n
//   are masked out, and the arena ends in slack for them. Nodes and blocks begin with a unit of 32
//   bytes. Blocks of the compact layout, about half as large, are those of wide_compact.h and begin
//   with a unit of 16.
// Slots: a ray with sign bits s (bit a set where it runs down axis a) visits the children of a node
//   in ascending order of slot XOR s (of slot XOR 2 s for W = 16), so slots are filled by position.
// Numbers are those of the tree's frame (wide_frame.h). Where the corners of all triangles are
//   floats of the frame (has_exact_corners; other things may be among them), lanes of triangles
//   hold the very corners of the scene, but in rounded blocks.
// Lanes: a thing that is no triangle has NaN corners. Every comparison of the kernels is written so
//   that NaN means "may be hit", so such a lane always goes to the exact test.
// Invariants: boxes enclose the things below them, rounded outward; an empty slot's box is
//   [+inf, -inf], which no ray enters.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include <strahl/structures/wide_bvh/wide_frame.h>

namespace strahl {

/// Bit 31: leaf. Bits 4..30: its first unit. Bits 0..3: the number of lanes of a leaf less one, 0
/// of a node, which lies at twice its id.
using WideId = std::uint32_t;

inline constexpr WideId kWideLeaf = 0x80000000u;
inline constexpr std::uint64_t kWideMaxUnits = std::uint64_t{1} << 27;  ///< 4 GiB, compact: 2
inline constexpr std::uint32_t kWideMaxLanes = 16;
inline constexpr int kWideMaxDepth = 64;        ///< inner nodes on a path
inline constexpr std::size_t kWideSlack = 128;  ///< bytes that may be read beyond the last block

constexpr bool is_leaf(WideId id) { return (id & kWideLeaf) != 0; }
/// The first unit, times 16.
constexpr std::uint32_t place_of(WideId id) { return id & 0x7ffffff0u; }
constexpr std::uint32_t lanes_of(WideId leaf) { return (leaf & 15u) + 1; }

/// Error bounds of the hit filter for one block; see wide_filter.h.
struct LeafBound {
  float per_distance =
      0;               ///< of edge values, per unit of the largest |a - org| component; negative
  float constant = 0;  ///< of edge values, whatever the distance; negative
  float to_t = 0;      ///< from edge values to t
  std::uint32_t word = 0;  ///< not 0 in a block of the compact layout, see wide_compact.h
};

/// How blocks hold corners: as rows of floats, or each once or rounded to 16 bits.
enum class WideLayout { full, compact };

constexpr std::size_t node_bytes(int width) { return 28u * static_cast<std::size_t>(width); }
/// Of a full block.
constexpr std::size_t leaf_bytes(std::size_t lanes) { return sizeof(LeafBound) + 40 * lanes; }
/// log2 of the bytes of a unit, of blocks and of nodes.
constexpr std::uint32_t unit_shift(WideLayout layout) { return layout == WideLayout::full ? 5 : 4; }
inline constexpr std::uint32_t kNodeShift = 5;
constexpr std::uint64_t units(std::size_t bytes, WideLayout layout) {
  const std::uint32_t shift = unit_shift(layout);
  return (bytes + (std::size_t{1} << shift) - 1) >> shift;
}

/// Row r of a node: low x, y, z, high x, y, z.
inline const float* plane_row(const std::byte* node, int width, int row) {
  return reinterpret_cast<const float*>(node) + std::ptrdiff_t{row} * width;
}
inline const WideId* child_row(const std::byte* node, int width) {
  return reinterpret_cast<const WideId*>(node) + std::ptrdiff_t{6} * width;
}
inline std::uint32_t leaf_word(const std::byte* leaf) {
  std::uint32_t word;
  std::memcpy(&word, leaf + offsetof(LeafBound, word), sizeof word);
  return word;
}
inline bool is_compact(const std::byte* leaf) { return leaf_word(leaf) != 0; }
/// Whether the block is compact and its corners are rounded to 16 bits.
inline bool is_rounded(const std::byte* leaf) { return (leaf_word(leaf) & 0xffu) != 0; }
/// Row r of a full block: a.x, a.y, a.z, b.x, ...
inline const float* corner_row(const std::byte* leaf, std::uint32_t lanes, std::uint32_t row) {
  return reinterpret_cast<const float*>(leaf + sizeof(LeafBound)) + std::size_t{row} * lanes;
}
inline const std::uint32_t* reference_row(const std::byte* leaf, std::uint32_t lanes,
                                          WideLayout layout) {
  const auto* behind_head = reinterpret_cast<const std::uint32_t*>(leaf + sizeof(LeafBound));
  return layout == WideLayout::full ? behind_head + std::size_t{9} * lanes : behind_head;
}
/// Of a block that is written.
inline const std::uint32_t* reference_row(const std::byte* leaf, std::uint32_t lanes) {
  return reference_row(leaf, lanes, is_compact(leaf) ? WideLayout::compact : WideLayout::full);
}

/// Zeroed memory whose beginning is aligned to cache lines; large ones lie in large pages where the
/// system has them.
class WideArena {
 public:
  WideArena() = default;
  explicit WideArena(std::uint64_t bytes);
  std::byte* data() { return data_.get(); }
  const std::byte* data() const { return data_.get(); }
  std::uint64_t size() const { return size_; }

 private:
  struct Free {
    void operator()(std::byte* p) const { std::free(p); }
  };
  std::unique_ptr<std::byte, Free> data_;
  std::uint64_t size_ = 0;
};

/// Entries of a stack that holds all that waits on a path of `depth` inner nodes: a bottom, all
/// children but one per node, and full vectors behind.
constexpr std::size_t wide_stack_room(int width, std::size_t depth) {
  const auto w = static_cast<std::size_t>(width);
  return (2 + depth * (w - 1) + 2 * w + 7) / 8 * 8;
}

/// Where nodes and blocks lie.
struct WidePlaces {
  const std::byte* base;
  std::uint32_t finer;  ///< 1 where units of blocks are half of those of nodes

  const std::byte* node(WideId id) const { return base + 2 * std::size_t{id}; }
  const std::byte* block(WideId id) const {
    return base + (std::size_t{place_of(id)} << (1 - finer));
  }
  /// Of either, without a branch.
  const std::byte* at(WideId id) const {
    return base + (std::size_t{place_of(id)} << (1 - (id >> 31 & finer)));
  }
};

/// All that a kernel needs of a tree. Empty when the arena is.
struct WideTree {
  WideArena arena;
  WideId root = 0;
  int width = 8;
  std::size_t depth = 0;  ///< most inner nodes on a path
  WideLayout layout = WideLayout::full;
  bool has_exact_corners = false;  ///< but in rounded blocks
  WideFrame frame;

  bool is_empty() const { return arena.size() == 0; }
  WidePlaces places() const { return {arena.data(), kNodeShift - unit_shift(layout)}; }
  const std::byte* at(WideId id) const { return places().at(id); }
  std::byte* at(WideId id) { return const_cast<std::byte*>(places().at(id)); }
  /// Whether a block holds the very corners of the scene.
  bool is_exact(const std::byte* leaf) const { return has_exact_corners && !is_rounded(leaf); }
};

}  // namespace strahl
