// build/float_clusters.h - primitives sorted along the Z-order curve and cut into small clusters.
//
// Source: [PantaleoniLuebke2010]: the upper levels of a tree are divided by clusters instead of by
//   primitives.
// Layout: clusters are FloatRefs whose reference is the first of `weight` neighbours in `sorted`.
// Method: codes of 10 bits per axis, cells being cubes; sorted by three stable passes over 10 bits;
//   cut where the codes differ first until few are left.
// Invariants: a cluster holds at most as many as asked for, or they all have the same code;
// together
//   they hold all things once; the order is that of codes, equal ones in the order given.
// Thread safety: pure functions.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/build/float_ref.h>

namespace strahl {

struct FloatClusters {
  std::unique_ptr<FloatRef[]> sorted;
  std::vector<FloatRef> clusters;
};

/// Bytes per thing at most, besides the refs given.
inline constexpr std::size_t kClusterBytes = 2 * sizeof(FloatRef) + 2 * sizeof(std::uint64_t);

/// O(n). The same for any executor. Throws Error{cancelled}.
/// @param centers box of the doubled centres of refs
/// @param most things of a cluster
FloatClusters make_clusters(std::span<const FloatRef> refs, const FloatBox& centers,
                            std::uint32_t most, const BuildContext& context);

}  // namespace strahl
