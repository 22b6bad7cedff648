// structures/wide_bvh/wide_write.h - how boxes and blocks are written into the arena, by the layout
// and when things have moved.
#pragma once

#include <cstdint>
#include <span>

#include <strahl/geometry/primitive_source.h>
#include <strahl/structures/wide_bvh/wide_any_order.h>
#include <strahl/structures/wide_bvh/wide_compact.h>
#include <strahl/structures/wide_bvh/wide_tree.h>

namespace strahl {

/// Makes every slot of a node one that no ray enters.
void clear_boxes(std::byte* node, int width);

/// Writes a child's box, rounded outward into the frame. The order of any hit stays.
void write_box(std::byte* node, int width, int slot, const Aabb& box, const WideFrame& frame);

/// Writes in which order rays of any hit visit the children of a node of 16, given by slot. Before
/// their boxes.
void write_any_order(std::byte* node, std::span<const Blocking, kOrderedWidth> children);

/// What writing a block found.
struct WrittenBlock {
  bool fits;             ///< into that many bytes, as a full one does; if not, nothing is written
  double triangle_area;  ///< Blocking's, in the tree's frame; NaN where things are no triangles
};

/// Bytes of a block of these lanes in the tree's frame and layout; a full one has one size.
BlockSizes block_sizes(std::span<const std::uint32_t> references, const WideTree& tree,
                       const PrimitiveSource& source);

/// Writes error bounds and corners of a block of these lanes, in the tree's frame and layout.
WrittenBlock write_block(std::byte* block, std::span<const std::uint32_t> references,
                         const WideTree& tree, const PrimitiveSource& source, std::size_t bytes);

}  // namespace strahl
