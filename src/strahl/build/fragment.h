// build/fragment.h - the part of a primitive inside a cell, as builders that divide space see it.
//
// Boxes are floats rounded outward, so a fragment never shrinks below the part it stands for, and
// a split plane taken from a fragment is a float already: it is stored and compared without
// rounding. Coordinates beyond float's range become infinite or the largest float; planes are only
// ever placed at finite floats, so such scenes are divided coarsely but never wrongly.
// Invariants: lo <= hi on every axis; no component is -0.
// Thread safety: values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <strahl/build/prim_ref.h>
#include <strahl/geometry/primitive_source.h>
#include <strahl/math/aabb.h>
#include <strahl/math/float_round.h>

namespace strahl {

/// Closed float box and the reference it belongs to. 28 bytes.
struct Fragment {
  std::array<float, 3> lo, hi;
  std::uint32_t reference;

  /// Whether it has no extent along the axis.
  bool is_planar(std::size_t axis) const { return lo[axis] == hi[axis]; }
  /// Shrinks to what is common with a box; false when nothing is.
  bool shrink_to(const Aabb& box);
};

/// One fragment per PrimRef, in order.
std::vector<Fragment> make_fragments(std::span<const PrimRef> refs);

/// An axis-perpendicular plane that divides a cell, and how the fragments fall.
struct SplitPlane {
  std::size_t axis = 0;
  float position = 0.0f;
  bool is_planar_left = true;  ///< fragments within the plane go below it
  std::size_t left_count = 0, right_count = 0;
  double cost = Aabb::kInf;  ///< infinite: no plane was found

  bool is_found() const { return cost < Aabb::kInf; }
};

/// The part of the cell below (or above) the plane.
Aabb below(const Aabb& cell, const SplitPlane& plane);
Aabb above(const Aabb& cell, const SplitPlane& plane);

/// Fragments of the two sides of a plane. In each half the untouched fragments come first, in their
/// old order, then those the plane cuts, in their old order.
struct FragmentHalf {
  std::vector<Fragment> fragments;
  std::size_t kept = 0;              ///< untouched fragments
  std::vector<std::uint32_t> place;  ///< new index per old fragment, kNowhere if cut or not here
  static constexpr std::uint32_t kNowhere = ~0u;
};
struct FragmentHalves {
  FragmentHalf left, right;
};

/// What divide_fragments() needs besides fragments and plane.
struct DivideRules {
  const PrimitiveSource* source = nullptr;  ///< cuts are bounded exactly; null: boxes are cut
  bool wants_places = false;                ///< fill FragmentHalf::place
};

/// Sorts fragments to the sides of a plane. Closed boxes: what only touches the plane goes to the
/// side it lies on, what lies within the plane to the side the plane names, so every point of a
/// fragment stays covered on at least one side; a traversal visits both sides of a plane it
/// touches. Cut fragments are bounded anew from the original primitive, so errors do not build up.
/// O(n).
FragmentHalves divide_fragments(std::span<const Fragment> fragments, const Aabb& cell,
                                const SplitPlane& plane, const DivideRules& rules);

}  // namespace strahl
