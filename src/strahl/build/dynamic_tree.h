// build/dynamic_tree.h - a finished hierarchy opened again, to take things out and to put others
// in.
//
// Source: insertion by branch and bound over the areas, as in build/optimise.h
// [MeisterBittner2018b]
//   and [GoldsmithSalmon1987].
// Method: the hierarchy becomes a linked binary tree of single references around where things are
//   now, without those that are gone; each new one is put beside the node where the sum of the
//   areas of the inner nodes grows least. The result is as any bottom-up builder's: depth is not
//   bounded, leaves of several are made afterwards (build/collapse.h).
// Thread safety: pure functions and values.
#pragma once

#include <span>

#include <strahl/build/hierarchy.h>
#include <strahl/build/linked_tree.h>

namespace strahl {

/// The tree without the things whose box is empty; without nodes if nothing is left. What a leaf
/// holds, and the children of wide nodes, are joined in pairs, in their order. O(nodes +
/// references).
/// @param boxes per thing
LinkedTree make_linked(const Hierarchy& hierarchy, std::span<const Aabb> boxes);

/// Looks at so many nodes per insertion and takes the best place by then: where all boxes coincide,
/// no bound helps.
inline constexpr int kMaxPlaceVisits = 512;

/// Puts a thing in; the first one becomes the root. O(log n) nodes looked at where boxes are small.
void insert_leaf(LinkedTree& tree, std::uint32_t reference, const Aabb& box);

}  // namespace strahl
