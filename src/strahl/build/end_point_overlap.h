// build/end_point_overlap.h - how much surface lies in nodes that it does not belong to.
//
// Source: [Aila2013]. Rays end on surfaces; where a node's box holds surface that is not below the
//   node, a ray that ends there has visited the node for nothing. The cost is the sum over all
//   nodes of what a visit costs times that area, over the area of the scene.
// Method: exact up to rounding: each triangle is cut to the box of every node that it reaches, from
//   the root down.
// Thread safety: pure functions.
#pragma once

#include <strahl/base/build_context.h>
#include <strahl/build/hierarchy.h>
#include <strahl/geometry/primitive_source.h>

namespace strahl {

/// In units of `cost`; 0 where there are no triangles: spheres and cones are left out.
/// O(triangles * boxes they reach), the same for any executor. Throws Error{cancelled}.
double end_point_overlap(const Hierarchy& hierarchy, const PrimitiveSource& source,
                         const SahCost& cost, const BuildContext& context);

}  // namespace strahl
