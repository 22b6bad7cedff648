// structures/hug/hug_plan.h - which grids there are, and what lies in which.
//
// Steps: sizes make groups; in all groups but the one of the largest, boxes that hang together make
//   clusters; each cluster of enough primitives gets a grid; each grid, and each primitive without
//   one, goes into the smallest grid of a coarser group whose box encloses it, else into the
//   outermost grid, which also takes the group of the largest.
// Thread safety: pure function.
#pragma once

#include <span>
#include <vector>

#include <strahl/build/prim_ref.h>

namespace strahl {

struct HugRules {
  int groups;           ///< at most
  double ratio;         ///< least ratio of the mean sizes of neighbouring groups
  double connectivity;  ///< distance within a cluster, in mean sizes of its group
  std::size_t min_cluster;
};

/// A grid to be made. Plan 0 is the outermost one.
struct HugPlan {
  int group = 0;
  Aabb box;
  std::vector<PrimRef> refs;  ///< ascending; grids as entries of NestedGrids
};

/// O(n log n) where few boxes overlap. refs ascend.
std::vector<HugPlan> plan_hug(std::span<const PrimRef> refs, const HugRules& rules,
                              const BuildContext& context);

}  // namespace strahl
