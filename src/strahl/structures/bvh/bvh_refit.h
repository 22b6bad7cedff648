// structures/bvh/bvh_refit.h - an old hierarchy around things that have moved, come or gone.
//
// Method:     as long as the same things can be hit, the nodes and their references stay and boxes
//             are made anew from the leaves up. Else the hierarchy is opened
//             (build/dynamic_tree.h), what is gone is left out, what is new is inserted, and leaves
//             are made again. What was cut is in all its leaves as a whole.
// Thread safety: pure functions.
#pragma once

#include <optional>

#include <strahl/base/build_context.h>
#include <strahl/build/hierarchy.h>
#include <strahl/geometry/primitive_source.h>
#include <strahl/structures/bvh/bvh_options.h>

namespace strahl {

/// Of the things, one of so many may come or go; where it is more, a build takes no longer.
inline constexpr std::size_t kFewChanges = 4;

/// Different references in a hierarchy over `size` things. O(references + size).
std::size_t count_things(const Hierarchy& hierarchy, std::uint32_t size);

/// Around where things are now; nothing where it should be built anew, as too many things have come
/// or gone. O(n + changes * log n). Deterministic for any executor. Throws Error{cancelled},
/// Error{resource}.
std::optional<Hierarchy> fit_hierarchy(Hierarchy hierarchy, const PrimitiveSource& source,
                                       const BvhOptions& options, const BuildContext& context);

}  // namespace strahl
