// build/ploc.h - bottom-up clustering of neighbours on the Z-order curve.
//
// Source: [MeisterBittner2018]. In rounds, each cluster finds the neighbour, among `radius` before
//   and after it, with which its box has the least area; pairs that chose each other are joined and
//   stay where the first one was, until one cluster is left.
// Differs from the paper: equal areas go to the pair that is closer on the curve, then to the one
//   that begins at an even place, so that equal boxes pair up instead of all choosing one; a round
//   that joins few pairs joins, in order, clusters with their choice where both are still free, so
//   that boxes which grow steadily along the curve do not take a round each.
// Invariant: the same tree for any number of threads.
#pragma once

#include <span>

#include <strahl/base/build_context.h>
#include <strahl/build/linked_tree.h>
#include <strahl/build/prim_ref.h>

namespace strahl {

/// O(n * radius) per round, about log n rounds. n > 0, radius > 0. Depth is not bounded.
/// Throws Error{cancelled}.
LinkedTree build_ploc_tree(std::span<const PrimRef> refs, int radius, const BuildContext& context);

}  // namespace strahl
