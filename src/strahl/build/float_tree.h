// build/float_tree.h - top-down division of boxes of floats into a neutral binary tree.
//
// Source: [Wald2007] for the division; as in [Ganestam2015] and [PantaleoniLuebke2010] the upper
//   levels divide small clusters (build/float_clusters.h) instead of primitives.
// Method: sets of clusters are opened once they hold few primitives or cannot be divided further;
//   opening gathers their primitives, so that all below works in the nearest cache.
//   Where things may be cut, a set owns free places behind it. Its sides get them by their
//   references and the root of their area: what is large is met more often.
// Invariants: those of a Tree; the result depends on the refs and rules only.
// Differs from the papers: clusters are cells of one grid with few primitives each.
#pragma once

#include <cstddef>
#include <span>

#include <strahl/base/build_context.h>
#include <strahl/build/float_cut.h>
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

/// When things are cut (build/float_cut.h).
struct FloatCutRules {
  int bins = 16;                ///< 2..FloatCutter::kMaxBins
  std::size_t least = 16;       ///< references; smaller sets are not searched for a plane
  float least_overlap = 1e-4f;  ///< of the sides of a division, as a part of the root's area
  int patience = 3;  ///< so many searches in vain on a path are its last, but for one found between
};

/// Bytes per primitive that the build takes besides refs and tree.
std::uint64_t float_tree_bytes(const FloatTreeRules& rules);

/// Divides refs down to leaves of at most `undivided`. O(n log n) expected. Overwrites refs. The
/// boxes are those of the refs. Deterministic for any executor. refs not empty.
/// Throws Error{cancelled}.
Tree build_float_tree(std::span<FloatRef> refs, const FloatTreeRules& rules,
                      const BuildContext& context);

/// The same where things may be cut: leaves then may have a reference twice, boxes may lie within
/// those of the refs. No clusters.
/// @param room the first `count` are given, the rest is free for what cuts add; 2^31 - 1 at most
Tree build_cut_float_tree(std::span<FloatRef> room, std::size_t count, const FloatTreeRules& rules,
                          const FloatCutRules& cuts, const FloatThings& things,
                          const BuildContext& context);

}  // namespace strahl
