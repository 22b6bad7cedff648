// build/spatial_tree.h - binned SAH with spatial splits: primitives that reach across a node may be
// cut, each part referred to by its side.
//
// Source: [Stich2009]. Object splits as in build/object_split.h; where their halves overlap, planes
// at
//   the borders of equal bins of the node's box are tried, too, and taken if cheaper. References
//   that are cheaper whole stay on one side ("unsplitting").
// Layout: all references in one array; a node owns a run of it and the free room behind, which its
//   children share by their sizes, so that growth is bounded and nothing is allocated per node.
// Invariants: the boxes of a primitive's references cover it; the tree is the same for any number
// of
//   threads.
#pragma once

#include <strahl/base/build_context.h>
#include <strahl/build/prim_ref.h>
#include <strahl/build/sah.h>
#include <strahl/build/tree.h>

namespace strahl {

struct SpatialRules {
  SahCost cost;
  int object_bins = 32;
  int spatial_bins = 32;
  double growth = 0.3;  ///< references there may be more than primitives, per primitive
  double least_overlap =
      1e-5;  ///< of halves, as a part of the root's area, from which cuts are tried
  int max_depth = 64;
};

/// Divides down to single references. n > 0. Throws Error{cancelled}, Error{resource}.
/// @param source whose things the references are, for cutting them
Tree build_spatial_tree(const PrimitiveSource& source, std::vector<PrimRef> refs, const Aabb& box,
                        const SpatialRules& rules, const BuildContext& context);

}  // namespace strahl
