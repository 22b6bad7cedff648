// build/end_point_overlap.h - how much surface lies in nodes that it does not belong to.
//
// Source: [Aila2013]. Rays end on surfaces; where a node's box holds surface that is not below the
//   node, a ray that ends there has visited the node for nothing. The cost is the sum over all
//   nodes of what a visit costs times that area, over the area of the scene.
// Method: each primitive's surface goes down the tree, cut to the box of every node that it does
//   not belong to (geometry/surface_piece.h): triangles exact up to rounding, spheres and cones by
//   small patches.
// Thread safety: pure functions.
#pragma once

#include <strahl/base/build_context.h>
#include <strahl/build/box_tree.h>
#include <strahl/geometry/scene.h>

namespace strahl {

/// In units of the tree's cost. O(primitives * boxes they reach), the same for any executor.
/// @param tree its references are those of the scene
/// Throws Error{cancelled}.
double end_point_overlap(const BoxTree& tree, const Scene& scene, const BuildContext& context);

}  // namespace strahl
