// structures/adaptive_grid/agglomerate.h - primitives joined to clusters while their boxes stay
// tight.
//
// Source: [KlimaszewskiSederberg1997]: two clusters are joined if the box of both has less than f
//   times the area of their boxes, and less than a part m of the scene's. In which order pairs are
//   tried it does not say; here [MeisterBittner2018]: clusters stand in an order in which
//   neighbours are close, each looks for the best partner within a few places, and those that
//   choose each other are joined, round after round. O(n log n) where a part of the clusters is
//   joined in each round; the number of rounds is limited.
// Differs from the paper: the order is that of the leaves of a tree over the boxes.
// Thread safety: pure function; the result does not depend on the executor.
#pragma once

#include <span>
#include <vector>

#include <strahl/build/prim_ref.h>

namespace strahl {

struct MergeRules {
  double growth;  ///< f: of the area by joining
  double part;    ///< m: of the scene's area that a cluster may have
};

struct Cluster {
  Aabb box;
  std::vector<PrimRef> refs;  ///< ascending
};

/// In an order in which neighbours are close. Throws Error{cancelled}.
std::vector<Cluster> agglomerate(std::span<const PrimRef> refs, const MergeRules& rules,
                                 const BuildContext& context);

}  // namespace strahl
