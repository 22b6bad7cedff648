// build/float_split.h - binned SAH over boxes of floats, for builds whose time counts.
//
// Source: [Wald2007]; three axes binned in one pass.
// Layout: a set is a range of one of two arrays of 32-byte FloatRefs. A division copies it in order
//   into the same range of the other one, so there is no branch to mispredict, and the references
//   of a set ascend where those of all do.
// Method: a box is its low corner and its high one negated (math/float4.h); the costs of the three
//   axes are the lanes of one vector. Boxes of both sides come from the bins, boxes of the centres
//   from the copying.
//   Things may have a weight: clusters of several primitives (build/float_clusters.h).
// Differs from the paper: as many bins as the caller asks for, fewer for small sets; empty bins add
//   no division.
// Thread safety: disjoint sets may be worked on at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include <strahl/build/float_ref.h>

namespace strahl {

/// References [begin, end) of one of the two arrays, and what bounds them.
struct FloatSet {
  std::uint32_t begin = 0, end = 0;
  bool in_second = false;
  FloatBox box, centers;  ///< centers: of the doubled centres
  std::size_t size() const { return end - begin; }
};

/// A division found; infinite cost when there is none. The cost is relative, for comparisons only.
struct FloatSplit {
  float cost = std::numeric_limits<float>::infinity();
  int axis = 0;
  float scale = 0, first_right = 0;  ///< left: (doubled centre - least) * scale < first_right
  std::uint32_t left_count = 0, left_weight = 0;
  FloatBox left, right;
  bool is_found() const { return cost < std::numeric_limits<float>::infinity(); }
};

class FloatSplitter {
 public:
  static constexpr int kMaxBins = 32;

  /// Both arrays of the same size, the first filled. They must outlive it.
  /// @param bins 2..kMaxBins
  /// @param are_weighted false where every weight is 1
  FloatSplitter(std::span<FloatRef> first, std::span<FloatRef> second, int bins, bool are_weighted)
      : arrays_{first, second}, bins_(bins), are_weighted_(are_weighted) {}

  /// Some of the first array. O(n).
  FloatSet bounded(std::uint32_t begin, std::uint32_t end) const;
  std::span<const FloatRef> refs_of(const FloatSet& set) const { return refs(set, set.in_second); }

  /// The cheapest division into two parts by bins. O(n).
  FloatSplit find(const FloatSet& set) const;
  /// @param gap places of the array left free between the two sides; the caller has them
  std::pair<FloatSet, FloatSet> divide(const FloatSet& set, const FloatSplit& split,
                                       std::uint32_t gap = 0) const;
  /// Halves by the order of centres on the longest axis of their box, then of references, then of
  /// places: parts of one thing have one reference. O(n) expected.
  std::pair<FloatSet, FloatSet> halve(const FloatSet& set, std::uint32_t gap = 0) const;
  /// The array into which a set is divided.
  FloatRef* target(const FloatSet& set) const { return arrays_[!set.in_second].data(); }

 private:
  std::span<FloatRef> refs(const FloatSet& set, bool second) const {
    return arrays_[second].subspan(set.begin, set.size());
  }

  std::span<FloatRef> arrays_[2];
  int bins_;
  bool are_weighted_;
};

}  // namespace strahl
