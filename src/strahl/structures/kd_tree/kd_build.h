// structures/kd_tree/kd_build.h - builds the nodes of a kd-tree, top down.
//
// Thread safety: the build runs on the executor of its context; the result does not depend on it.
#pragma once

#include <strahl/structures/kd_tree/kd_tree.h>

namespace strahl {

/// Nodes and references of a tree over refs, whose boxes lie in root. The report receives all but
/// the time.
/// Throws Error{resource}, Error{cancelled}.
KdArrays build_kd_tree(const PrimitiveSource& source, std::vector<PrimRef> refs, const Aabb& root,
                       const KdTreeOptions& options, const BuildContext& context,
                       BuildReport& report);

}  // namespace strahl
