// build/side_tree.h - the tree of a structure as its measures see it: volumes of any kind by their
// sides, and trees below what is referred to.
//
// Layout: the sides of node i are sides[first_side[i]] .. sides[first_side[i + 1]]. A tree over
//   primitives has no things; one over instances, or over runs of either, has one per reference.
// Invariants: things ascend, together they hold each number of the tree once; only things that are
//   instances are placed, and none is below another.
// Thread safety: values.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <strahl/bounds/enclosed_set.h>
#include <strahl/bounds/side.h>
#include <strahl/build/box_tree.h>
#include <strahl/math/affine.h>

namespace strahl {

/// Where the contents of an instance are.
struct Placement {
  explicit Placement(const Affine& map) : to_object(map), stretch(longest_stretch(map)) {}

  Affine to_object;
  double stretch;  ///< at least the longest length that a length of 1 gets in object space
};

struct SideTree {
  /// Primitives [first, first + size) of the tree that refers to it, by a tree of their own.
  struct Thing {
    std::shared_ptr<const SideTree> tree;
    std::uint32_t first = 0, size = 0;
    std::optional<Placement> placement;  ///< none: it lies where its tree says
  };

  Hierarchy nodes;  ///< without boxes
  std::vector<VolumeSide> sides;
  std::vector<std::uint32_t> first_side{0};
  std::vector<double> extents;  ///< of each node the largest along the axes
  VisitCost cost;
  std::vector<Thing> things;

  /// Says the volume of the next node.
  template <class V>
  void add_volume(const V& volume) {
    SideList list(sides);
    volume.add_sides_to(list);
    first_side.push_back(static_cast<std::uint32_t>(sides.size()));
    EnclosedSet corners;
    volume.add_corners_to(corners);
    extents.push_back(corners.is_unbounded() ? Aabb::kInf : norm_max(corners.box().extent()));
  }
  std::span<const VolumeSide> sides_of(std::uint32_t node) const {
    return std::span(sides).subspan(first_side[node], first_side[node + 1] - first_side[node]);
  }
};

SideTree make_side_tree(BoxTree tree);

/// The tree with things in place of what it refers to; where it has things already, in place of
/// what is at the bottom of them. @param things one per number of the tree
SideTree with_things(SideTree tree, std::span<const SideTree::Thing> things);

}  // namespace strahl
