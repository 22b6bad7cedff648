// structures/bvh/bvh_build.h - the hierarchy that the options of a bvh ask for, before volumes.
#pragma once

#include <strahl/base/build_context.h>
#include <strahl/build/hierarchy.h>
#include <strahl/geometry/primitive_source.h>
#include <strahl/structures/bvh/bvh_options.h>

namespace strahl {

/// No path of a bvh is longer.
inline constexpr int kBvhMaxDepth = 64;
/// No node has more children, whatever the options.
inline constexpr int kBvhMaxArity = 16;

/// Over everything that can be hit; without nodes if nothing can. No deeper than kBvhMaxDepth, no
/// node with more children than the option allows.
/// Deterministic for any executor. Throws Error{cancelled} and Error{resource}.
Hierarchy build_bvh_hierarchy(const PrimitiveSource& source, const BvhOptions& options,
                              const BuildContext& context);

}  // namespace strahl
