// build/end_point_overlap.h - how much surface lies in nodes that it does not belong to.
//
// Source: [Aila2013]. Rays end on surfaces; where a node's volume holds surface that is not below
//   the node, a ray that ends there has visited the node for nothing. The cost is the sum over all
//   nodes of what a visit costs times that area, over the area of the scene.
// Method: each primitive's surface goes down the tree, cut to the volume of every node that it does
//   not belong to. Boxes: geometry/surface_piece.h, triangles exact up to rounding, spheres and
//   cones by small patches. Volumes of other kinds and nested trees: build/cut_piece.h, exact where
//   planes bound the volume of a triangle.
// Volumes that reach out of those above them count only inside all of these, as a ray has to pass
//   them all.
// Nested trees: surface is that of the instances in the world, each by itself. A leaf of the top
//   costs what it refers to; then each instance in it costs its own tree, in its place, where the
//   surface is in the leaf: of all instances but the one that it belongs to, the whole tree is
//   foreign.
// Thread safety: pure functions.
#pragma once

#include <strahl/base/build_context.h>
#include <strahl/build/box_tree.h>
#include <strahl/build/side_tree.h>
#include <strahl/geometry/scene.h>

namespace strahl {

/// In units of the tree's cost. O(primitives * boxes they reach), the same for any executor.
/// @param tree its references are those of the scene
/// Throws Error{cancelled}.
double end_point_overlap(const BoxTree& tree, const Scene& scene, const BuildContext& context);

/// The same of volumes of any kind. @param tree its numbers are those of the scene
double end_point_overlap(const SideTree& tree, const Scene& scene, const BuildContext& context);

}  // namespace strahl
