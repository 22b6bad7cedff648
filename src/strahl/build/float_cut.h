// build/float_cut.h - spatial splits of boxes of floats: a plane divides a set, what reaches across
// it is cut, or kept whole on one side where that is cheaper.
//
// Source: [Stich2009], reference unsplitting too.
// Layout: as build/float_split.h: a set is copied into the other of two arrays, its sides right
//   behind each other or with a gap; cut references are copied twice.
// Method: bins are slabs of the set's box, three axes in one pass; a box is cut by the slabs for
//   the search, the thing itself only by the plane found.
// Invariants: the boxes of a thing's references cover it. Both sides get at least one reference
//   that is not cut, so no side is empty and each is smaller than the whole.
// Differs from the paper: whether a reference stays whole is decided by the boxes of the search, in
//   the order of the set.
// Thread safety: const methods on disjoint sets.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include <strahl/build/float_split.h>
#include <strahl/math/vec3.h>

namespace strahl {

/// What the references stand for, in the coordinates of their boxes.
class FloatThings {
 public:
  virtual ~FloatThings() = default;
  /// Corners of a triangle, each component within rounding() of the true one; false for what is
  /// none: its box is cut instead.
  virtual bool corners(std::uint32_t reference, std::array<Vec3d, 3>& out) const = 0;
  virtual double rounding() const = 0;
  /// No coordinate is larger.
  virtual double reach() const = 0;
};

/// A plane found; infinite cost when there is none. The cost is that of a FloatSplit.
struct FloatCut {
  float cost = std::numeric_limits<float>::infinity();
  int axis = 0;
  float plane = 0;
  int bins = 0, first_right = 0;      ///< the plane is the lower border of that bin
  std::uint32_t left = 0, right = 0;  ///< references at most
  FloatBox left_box, right_box;
  bool is_found() const { return cost < std::numeric_limits<float>::infinity(); }
};

class FloatCutter {
 public:
  static constexpr int kMaxBins = 32;

  /// All must outlive it.
  /// @param bins 2..kMaxBins
  FloatCutter(const FloatSplitter& splitter, const FloatThings& things, int bins)
      : splitter_(splitter), things_(things), bins_(bins) {}

  /// The cheapest plane with which there are at most `spare` references more. O(n).
  FloatCut find(const FloatSet& set, std::uint32_t spare) const;
  /// The left side begins where the set does, the right one at right_begin, at least cut.left
  /// further.
  std::pair<FloatSet, FloatSet> divide(const FloatSet& set, const FloatCut& cut,
                                       std::uint32_t right_begin) const;

 private:
  class Sides;
  const FloatSplitter& splitter_;
  const FloatThings& things_;
  int bins_;
};

/// Boxes of the parts of a triangle on the two sides of a plane perpendicular to an axis, within a
/// box; empty where there is none. Rounded outward.
std::pair<FloatBox, FloatBox> cut_box(const FloatThings& things, const FloatRef& ref, int axis,
                                      float plane);

}  // namespace strahl
