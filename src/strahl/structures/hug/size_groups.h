// structures/hug/size_groups.h - tells large primitives from small ones.
//
// Source: the histogram of sizes of [Cazals1995]. A size is the diagonal of a box, taken by its
//   logarithm. The cuts are those with the least sum of squared deviations from the groups' means,
//   found by trying all ([Fisher1958]); the papers leave open how a histogram is cut.
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

/// At most `most` groups, whose mean sizes differ by at least the ratio from one to the next.
/// At least one group; O(n + most * bins^2).
SizeGroups find_size_groups(std::span<const PrimRef> refs, int most, double ratio);

}  // namespace strahl
