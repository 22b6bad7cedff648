// structures/bvh/bvh_refit.h - an old hierarchy around things that have moved.
//
// Method:     the nodes and their references stay, boxes are made anew from the leaves up. What was
//             cut is in all its leaves as a whole.
// Thread safety: pure functions.
#pragma once

#include <optional>

#include <strahl/base/build_context.h>
#include <strahl/build/hierarchy.h>
#include <strahl/geometry/primitive_source.h>

namespace strahl {

/// Different references in a hierarchy over `size` things. O(references + size).
std::size_t count_things(const Hierarchy& hierarchy, std::uint32_t size);

/// With boxes around where things are now; nothing when other things can be hit than those it
/// refers to. O(nodes + size). Deterministic for any executor. Throws Error{cancelled},
/// Error{resource}.
std::optional<Hierarchy> fit_hierarchy(Hierarchy hierarchy, const PrimitiveSource& source,
                                       const BuildContext& context);

}  // namespace strahl
