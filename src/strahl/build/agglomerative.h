// build/agglomerative.h - bottom-up clustering: always the two clusters whose common box has the
// least area.
//
// Source: [Walter2008]. The area of a common box never shrinks when a cluster grows, so two
// clusters
//   that are each other's nearest may be joined at once, and a cluster's nearest stays the nearest
//   until it is joined: the tree is that of the greedy choice among all pairs, up to equal areas.
// Search: a balanced tree over the clusters' centres with the least extents of the boxes below,
//   made anew whenever half of the clusters are gone; a joined cluster takes the place of one part.
// Differs from the paper: no heap; in rounds, all clusters without a nearest one search for it at
//   once, then pairs are joined in order. Where areas are equal, either choice counts as mutual.
// Invariant: the same tree for any number of threads.
#pragma once

#include <span>

#include <strahl/base/build_context.h>
#include <strahl/build/linked_tree.h>
#include <strahl/build/prim_ref.h>

namespace strahl {

/// O(n log n) where boxes are small against their distances, O(n^2) at worst: boxes all
/// within each other. n > 0. Depth is not
/// bounded. Throws Error{cancelled}.
LinkedTree build_agglomerative_tree(std::span<const PrimRef> refs, const BuildContext& context);

/// Bytes at its peak beside the references and the tree.
constexpr std::uint64_t agglomerative_bytes(std::uint64_t primitives) { return 160 * primitives; }

}  // namespace strahl
