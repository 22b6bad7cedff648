// build/float_tree.h - top-down division of boxes of floats into a neutral binary tree.
//
// Source: [Wald2007] for the division; as in [Ganestam2015] and [PantaleoniLuebke2010] the upper
//   levels divide small clusters (build/float_clusters.h) instead of primitives.
// Method: sets of clusters are opened once they hold few primitives or cannot be divided further;
//   opening gathers their primitives, so that all below works in the nearest cache.
// Invariants: those of a Tree; the result depends on the refs and rules only.
// Differs from the papers: clusters are cells of one grid with few primitives each.
#pragma once

#include <cstddef>
#include <span>

#include <strahl/base/build_context.h>
#include <strahl/build/float_ref.h>
#include <strahl/build/tree.h>

namespace strahl {

struct FloatTreeRules {
  int bins = 16;              ///< 2..32
  std::size_t undivided = 4;  ///< so few are a leaf without asking what a division would cost
  int max_depth = 64;         ///< hard limit; near it sets are halved so that it holds
  std::uint32_t cluster = 0;  ///< primitives of a cluster at most; 0: no clusters
  std::uint32_t opened = 0;   ///< clusters of so few primitives are opened
};

/// Bytes per primitive that the build takes besides refs and tree.
std::uint64_t float_tree_bytes(const FloatTreeRules& rules);

/// Divides refs down to leaves of at most `undivided`. O(n log n) expected. Overwrites refs. The
/// boxes are those of the refs. Deterministic for any executor. refs not empty.
/// Throws Error{cancelled}.
Tree build_float_tree(std::span<FloatRef> refs, const FloatTreeRules& rules,
                      const BuildContext& context);

}  // namespace strahl
