// structures/hug/box_clusters.h - which boxes hang together.
//
// How: a flood fill over a tree of the boxes. A box that is found leaves the tree, so each is found
//   once, however many overlap it: O(n log n) where few boxes cross the borders of a tree node.
// Thread safety: pure function.
#pragma once

#include <span>
#include <vector>

#include <strahl/build/prim_ref.h>

namespace strahl {

/// Sets of positions in `refs`, each ascending, ordered by their first. Two boxes hang together
/// when no axis separates them by more than `distance`, or, where it is negative, when they overlap
/// by as much on each axis; and so do boxes that hang together with a third one.
std::vector<std::vector<std::uint32_t>> find_clusters(std::span<const PrimRef> refs,
                                                      double distance, const BuildContext& context);

}  // namespace strahl
