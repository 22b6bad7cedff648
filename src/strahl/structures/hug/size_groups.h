// structures/hug/size_groups.h - tells large primitives from small ones.
//
// Source: the histogram of sizes of [Cazals1995]. A size is the diagonal of a box, taken by its
//   logarithm. The papers leave open how a histogram is cut. Here it is cut at its widest gap, as
//   long as there is one as wide as the ratio asks for: a floor is not of a kind with what stands
//   on it. Then into parts that deviate least from their means ([Fisher1958]).
// Thread safety: pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <strahl/build/prim_ref.h>

namespace strahl {

struct SizeGroups {
  std::vector<std::uint8_t> group_of;  ///< by position in the refs; 0 is the smallest
  std::vector<double> mean;            ///< size of each group, geometric; ascending
};

/// At most `most` groups; the sizes of two neighbours, or their means, differ by the ratio or more.
/// At least one group; O(n + most^2 * bins).
SizeGroups find_size_groups(std::span<const PrimRef> refs, int most, double ratio);

}  // namespace strahl
