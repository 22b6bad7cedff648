// structures/bih/bih_node.h - 12-byte nodes of a bounding interval hierarchy.
//
// Layout: packed: bits 0-2 side of the first plane, bits 3-5 of the second, bits 6-31 the (first)
//   child. A side is 2 * axis + (1 if what lies above the plane is kept). The first code tells the
//   other two kinds of node: 6 a trimmed node, whose one child lies between the planes of the axis
//   in the second code, 7 a leaf, whose words are its first reference and their number.
// Thread safety: values.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <strahl/base/hash.h>
#include <strahl/math/aabb.h>
#include <strahl/math/ray.h>

namespace strahl {

/// A half-space: x[axis] >= plane if is_above, else x[axis] <= plane.
struct AxisSide {
  int axis = 0;
  bool is_above = false;
  double plane = 0.0;

  /// The part of the box in it.
  Aabb cut(Aabb box) const {
    (is_above ? box.lo : box.hi)[axis] = plane;
    return box;
  }
};

/// An inner node with two children, each behind its own plane; one with one child between two
/// planes; or a leaf.
class BihNode {
 public:
  static constexpr std::size_t kMaxIndex = (std::size_t{1} << 26) - 1;

  static BihNode leaf(std::uint32_t first, std::uint32_t count) { return {first, count, kLeaf}; }
  /// @param child index of the left child; the right one follows it
  static BihNode inner(const AxisSide& left, const AxisSide& right, std::size_t child);
  static BihNode trimmed(int axis, double lo, double hi, std::size_t child);

  bool is_leaf() const { return (packed_ & 7u) == kLeaf; }
  std::uint32_t first() const { return word_[0]; }
  std::uint32_t count() const { return word_[1]; }

  bool is_trimmed() const { return (packed_ & 7u) == kTrimmed; }
  int trimmed_axis() const { return static_cast<int>(packed_ >> 3 & 7u); }
  double plane(std::size_t which) const {
    return static_cast<double>(std::bit_cast<float>(word_[which]));
  }
  std::uint32_t child() const { return packed_ >> 6; }
  /// The side of the left (0) or right (1) child.
  AxisSide side(std::size_t which) const {
    const std::uint32_t code = packed_ >> 3 * which & 7u;
    return {static_cast<int>(code >> 1), (code & 1u) != 0, plane(which)};
  }
  void hash_into(Hash64& hash) const { hash.add(word_[0]), hash.add(word_[1]), hash.add(packed_); }

 private:
  static constexpr std::uint32_t kTrimmed = 6, kLeaf = 7;
  BihNode(std::uint32_t first, std::uint32_t second, std::uint32_t packed)
      : word_{first, second}, packed_(packed) {}
  std::uint32_t word_[2];
  std::uint32_t packed_;
};
static_assert(sizeof(BihNode) == 12);

/// Nodes, siblings adjacent and behind their parent, and what leaves refer to.
struct BihArrays {
  std::vector<BihNode> nodes;
  std::vector<std::uint32_t> references;
};

}  // namespace strahl
