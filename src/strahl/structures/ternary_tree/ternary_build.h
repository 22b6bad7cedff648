// structures/ternary_tree/ternary_build.h - builds the nodes of a ternary tree, top down.
//
// Before a cell is divided, its oversized fragments are looked for. They leave the cell if a plane
// is worth it for the rest and, with decide=cost, if that is expected to be cheaper in one level:
//   C(oversized) + C_split(rest) < C_split(all), C(oversized) what a list or a split of them costs.
// Thread safety: the build runs on the executor of its context; the result does not depend on it.
#pragma once

#include <strahl/structures/ternary_tree/ternary_tree.h>

namespace strahl {

/// Nodes and references of a tree over refs, whose boxes lie in root. The report receives all but
/// the time.
/// Throws Error{resource}, Error{cancelled}.
KdArrays build_ternary_tree(const PrimitiveSource& source, std::vector<PrimRef> refs,
                            const Aabb& root, const TernaryTreeOptions& options,
                            const BuildContext& context, BuildReport& report);

}  // namespace strahl
