// build/kd_node.h - 8-byte nodes of trees that divide space by planes.
//
// Source: [WaldHavran2006]; the two flag bits are taken from the index, not from the split plane,
//   so the plane is stored as the builder used it.
// Layout: depth first, the left child follows its parent. packed: bits 0-1 axis, 3 for a leaf;
//   bits 2-31 right child or number of references. word: bits of the split plane; the place of
//   a leaf's first reference, the reference itself when there is one, 0 when there is none.
//   A split plane that is NaN divides no space: both children have the node's cell, the left one
//   the oversized primitives (ternary trees only).
// Thread safety: values.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <strahl/base/hash.h>

namespace strahl {

/// An inner node (axis, plane, right child), a filter (right child) or a leaf (references).
class KdNode {
 public:
  static constexpr std::size_t kMaxIndex = (std::size_t{1} << 30) - 1;

  /// The right child is linked when it is known.
  static KdNode inner(std::size_t axis, float plane) {
    return {std::bit_cast<std::uint32_t>(plane), static_cast<std::uint32_t>(axis)};
  }
  /// The left child holds what is filtered out, the right one the rest.
  static KdNode filter() { return inner(0, std::numeric_limits<float>::quiet_NaN()); }
  /// @param word the reference if count is 1, else the place of the first one; 0 if count is 0
  static KdNode leaf(std::uint32_t word, std::size_t count) {
    return {word, static_cast<std::uint32_t>(count) << 2 | kLeaf};
  }

  bool is_leaf() const { return (packed_ & 3u) == kLeaf; }

  bool is_filter() const { return !is_leaf() && plane() != plane(); }

  int axis() const { return static_cast<int>(packed_ & 3u); }
  double plane() const { return static_cast<double>(std::bit_cast<float>(word_)); }
  std::uint32_t right() const { return packed_ >> 2; }
  void link_right(std::size_t child) {
    packed_ = static_cast<std::uint32_t>(child) << 2 | (packed_ & 3u);
  }

  std::size_t count() const { return packed_ >> 2; }
  /// Position of the first reference of a leaf with several.
  std::uint32_t first() const { return word_; }
  void move_first(std::size_t by) { word_ += static_cast<std::uint32_t>(by); }
  void hash_into(Hash64& hash) const { hash.add(word_), hash.add(packed_); }
  /// @param all the tree's references; a single one lies in the node, which must outlive the span
  std::span<const std::uint32_t> references(const std::vector<std::uint32_t>& all) const {
    if (count() == 1) return {&word_, 1};
    return {all.data() + word_, count()};
  }

 private:
  static constexpr std::uint32_t kLeaf = 3;
  KdNode(std::uint32_t word, std::uint32_t packed) : word_(word), packed_(packed) {}
  std::uint32_t word_, packed_;
};
static_assert(sizeof(KdNode) == 8);

/// Nodes and the references of leaves with several.
struct KdArrays {
  std::vector<KdNode> nodes;
  std::vector<std::uint32_t> references;
};

}  // namespace strahl
