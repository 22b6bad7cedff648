// structures/wide_bvh/wide_refit.h - a wide tree around things that have moved.
//
// Method:     nodes, slots and references stay; blocks are written anew and boxes made from them
//             upwards, the subtrees of the upper levels at once. What spatial splits have cut is in
//             all its blocks as a whole. Slots keep their places, so where things have moved far
//             the order of visits is worse; no answer depends on it.
// Invariants: the result is a function of old tree and things, not of threads; the old tree is left
//             as it is.
// Thread safety: pure functions.
#pragma once

#include <optional>

#include <strahl/base/build_context.h>
#include <strahl/geometry/primitive_source.h>
#include <strahl/structures/wide_bvh/wide_tree.h>

namespace strahl {

struct FittedWideTree {
  WideTree tree;
  double cost = 0.0;  ///< as Collapse::cost()
};

/// Around where things are now; nothing where others can be hit than the tree holds. O(n).
/// Throws Error{cancelled}, Error{resource}.
std::optional<FittedWideTree> fit_wide_tree(const WideTree& tree, const PrimitiveSource& source,
                                            const BuildContext& context);

}  // namespace strahl
