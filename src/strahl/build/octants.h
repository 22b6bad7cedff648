// build/octants.h - cells divided on several axes at once: the tree behind octree and quadtree.
//
// Source: [Glassner1984]; planes by cost [Whang1995]; enlarged cells [Ulrich2000].
// Layout: the children of a node are consecutive, so a node names their block only. A child's place
//   in its block has a bit per divided axis, the first axis highest: 0 for the half below the
//   plane, 1 for the half above. Blocks are numbered depth first; block 0 belongs to the root, node
//   0.
// Invariants: a half below a plane holds nothing above OctantTree::end(), one above nothing below
//   begin(); begin <= end, so halves cover their parent. Enlarged halves also begin at low() and
//   end at high(). An axis that cannot be divided (no double lies strictly inside the cell) has its
//   planes at infinity and nothing above them. In leaves: a primitive is referred to by every
//   closed leaf cell that its box touches, with `exact` that it touches itself. At inner nodes: it
//   is referred to once, by the node that no child of which encloses its box. References of a node
//   ascend.
// Thread safety: trees are read-only after the build.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <strahl/base/hash.h>
#include <strahl/base/options.h>
#include <strahl/build/build_report.h>
#include <strahl/build/prim_ref.h>

namespace strahl {

enum class OctantPlace { leaves, inner };
enum class OctantSplit { middle, octree_r };
enum class OctantTraversal { parametric, neighbour };

/// Defaults are measured, see structures/octree/README.md.
struct OctantOptions {
  OctantPlace place = OctantPlace::leaves;
  OctantSplit split = OctantSplit::octree_r;
  OctantTraversal traversal = OctantTraversal::parametric;
  double looseness = 1.0;
  bool exact = true;
  bool cube = false;
  double padding = 0.001;
  int max_depth = 0;
  int max_prims = 4;
  double max_growth = 8.0;
};

/// Deepest leaf a tree may have, the root having depth 0.
inline constexpr int kMaxOctantDepth = 32;

/// The rows of an option table that octree and quadtree share. O derives from OctantOptions.
template <class O>
OptionTable<O> octant_fields() {
  return {
      option<O, OctantPlace>("place", &O::place,
                             {{"leaves", OctantPlace::leaves}, {"inner", OctantPlace::inner}},
                             "primitives in every leaf they touch, or once, at the smallest cell "
                             "that encloses them"),
      option<O, OctantSplit>("split", &O::split,
                             {{"middle", OctantSplit::middle}, {"octree_r", OctantSplit::octree_r}},
                             "planes in the middle, or per axis the cheapest of ten places between "
                             "the middle and the median of the primitives"),
      option<O, OctantTraversal>(
          "traversal", &O::traversal,
          {{"parametric", OctantTraversal::parametric}, {"neighbour", OctantTraversal::neighbour}},
          "down from the root with a stack, or from each leaf to the next by way of their nearest "
          "common ancestor"),
      option<O>("looseness", &O::looseness, 1.0, 4.0,
                "cells are enlarged this many times, with place=inner (2: loose octree)"),
      option<O>("exact", &O::exact, "list a primitive where it is, not where its box is"),
      option<O>("cube", &O::cube, "the root cell is a cube"),
      option<O>("padding", &O::padding, 0.0, 1.0,
                "part of its size by which the root cell is larger than the scene on each side"),
      option<O>("max_depth", &O::max_depth, 0, kMaxOctantDepth,
                "depth of leaves at most; 0: 6 + log4 of the primitives"),
      option<O>("max_prims", &O::max_prims, 1, 1000000, "primitives that are never divided"),
      option<O>("max_growth", &O::max_growth, 1.0, 1000000.0,
                "references per primitive at most; cells share what is left by their contents"),
  };
}

/// The axes that are divided, and how many: 3 make an octree, 2 a quadtree.
struct OctantAxes {
  std::array<int, 3> axis{0, 1, 2};
  int count = 3;

  static OctantAxes all_but(int undivided) {
    return {{(undivided + 1) % 3, (undivided + 2) % 3, undivided}, 2};
  }
  int operator[](int k) const { return axis[static_cast<std::size_t>(k)]; }
  std::uint32_t children() const { return 1u << count; }
  /// Whether a child, by its place in its block, lies above the plane of the k-th divided axis.
  bool is_above(std::uint32_t child, int k) const { return (child >> (count - 1 - k) & 1u) != 0; }
};

/// A cell. 12 bytes.
struct OctantNode {
  static constexpr std::uint32_t kLeaf = ~0u;
  std::uint32_t block = kLeaf;  ///< of the children
  std::uint32_t first = 0;      ///< its references
  std::uint32_t count = 0;
};

/// The same tree while it is built, nodes depth first.
struct OctantParts {
  struct Node {
    bool is_inner;
    std::uint32_t count;
  };
  std::vector<Node> nodes;
  std::vector<Vec3d> planes;
  std::vector<std::uint32_t> references;
};

/// Cells, planes and references. 12 bytes per cell, 24 or 96 per inner one, 4 per reference.
class OctantTree {
 public:
  OctantTree() = default;
  /// Throws Error{resource} above the memory limit or beyond 2^32 cells or references,
  /// Error{cancelled}. @param what names the structure in messages
  OctantTree(const PrimitiveSource& source, const OctantOptions& options, const OctantAxes& axes,
             const BuildContext& context, const char* what);

  bool is_empty() const { return references_.empty(); }
  const Aabb& box() const { return box_; }
  const OctantAxes& axes() const { return axes_; }
  const OctantNode& node(std::uint32_t index) const { return nodes_[index]; }
  bool is_leaf(std::uint32_t index) const { return nodes_[index].block == OctantNode::kLeaf; }
  std::span<const std::uint32_t> references(std::uint32_t index) const {
    return {references_.data() + nodes_[index].first, nodes_[index].count};
  }
  /// First of the consecutive children of a block.
  std::uint32_t child(std::uint32_t block) const { return 1 + (block << axes_.count); }
  /// Where halves below the planes of a block end and where those above begin.
  const Vec3d& end(std::uint32_t block) const { return planes_[std::size_t{block} * stride_]; }
  const Vec3d& begin(std::uint32_t block) const {
    return planes_[std::size_t{block} * stride_ + stride_ - 1];
  }
  bool is_loose() const { return stride_ > 1; }
  /// Where halves below begin and those above end. Requires: is_loose().
  const Vec3d& low(std::uint32_t block) const { return planes_[block * stride_ + 1]; }
  const Vec3d& high(std::uint32_t block) const { return planes_[block * stride_ + 2]; }
  /// The part of `whole` in a child, by its place in its block.
  Aabb part(const Aabb& whole, std::uint32_t block, std::uint32_t place) const;

  /// Block that the node is a child in. Requires: not the root.
  std::uint32_t block_of(std::uint32_t index) const { return (index - 1) >> axes_.count; }
  /// The node whose children the block holds. Requires: traversal=neighbour.
  std::uint32_t parent(std::uint32_t block) const { return parents_[block]; }
  /// The part of the scene's box that the planes above the block leave. Requires the same.
  const Aabb& reach(std::uint32_t block) const { return reaches_[block]; }

  const BuildReport& report() const { return report_; }
  /// Throws std::logic_error naming the first broken invariant.
  void validate(const PrimitiveSource& source) const;
  void hash_into(Hash64& hash) const;

 private:
  friend class OctantLayout;
  friend class OctantChecker;

  const char* what_ = "";
  OctantOptions options_;
  OctantAxes axes_;
  std::uint32_t stride_ = 1;
  int max_depth_ = 0;
  Aabb box_;   ///< of the primitives
  Aabb root_;  ///< the root cell
  std::vector<OctantNode> nodes_;
  std::vector<Vec3d> planes_;
  std::vector<std::uint32_t> references_;
  std::vector<std::uint32_t> parents_;  ///< per block, for traversal=neighbour only
  std::vector<Aabb> reaches_;
  BuildReport report_;
};

/// Planes per axis and block: one, or four of enlarged cells.
std::uint32_t octant_stride(const OctantOptions& options);

/// Root cell of a tree over primitives in box.
Aabb octant_root(const Aabb& box, const OctantOptions& options);

/// Depth at which cells are no longer divided: the option, or 6 + log4(n), rounded down.
int octant_depth_limit(const OctantOptions& options, std::size_t primitives);

/// Nodes and references over refs. Strict cells tile root.
OctantParts build_octants(const PrimitiveSource& source, std::vector<PrimRef> refs,
                          const Aabb& root, const OctantOptions& options, const OctantAxes& axes,
                          const BuildContext& context, const char* what);

}  // namespace strahl
