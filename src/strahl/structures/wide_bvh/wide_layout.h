// structures/wide_bvh/wide_layout.h - a collapsed tree written into the arena of a wide tree.
#pragma once

#include <strahl/build/build_report.h>
#include <strahl/build/collapse.h>
#include <strahl/geometry/primitive_source.h>
#include <strahl/structures/wide_bvh/wide_tree.h>

namespace strahl {

/// The slot of each child of a node: greedily the pair of child and free slot that fit best, then
/// two exchanged, or one moved, as long as that fits better. A slot fits a child as far as the
/// child lies on the slot's side of the node's middle.
/// @param centers of the children
void assign_slots(std::span<const Vec3d> centers, const Vec3d& middle, int width,
                  std::span<int> slots);

/// Writes nodes depth first, each followed by its blocks and then its inner children. Subtrees are
/// measured first, so that they can be written at once; the result does not depend on threads. Sets
/// nodes, leaves, references, depth and bytes of the report.
/// Throws Error{resource} above the memory limit or 4 GiB (compact: 2), Error{cancelled}.
/// @param box_frame of the tree's boxes into the wide tree's frame: that itself, or none where they
/// are in it
/// @param empty a tree that says width, layout, frame and whether corners are exact
/// @param source whose things the references are
WideTree lay_out_wide(const Tree& tree, const Collapse& collapse, const WideFrame& box_frame,
                      WideTree empty, const PrimitiveSource& source, const BuildContext& context,
                      BuildReport& report);

}  // namespace strahl
