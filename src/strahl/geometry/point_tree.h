// geometry/point_tree.h - finds marked points in a region of the plane; marks come and go.
//
// Layout:     binary tree over all points, split at the median of the wider side of their box, so
//             its depth is at most log2(n) + 1; every node counts the marked points below it.
// Invariants: node.marked is the number of marked points in its run of order_; a parent's run is
//             that of its two children.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <strahl/math/orient2d.h>

namespace strahl {

/// A closed axis-parallel rectangle.
struct Box2 {
  Point2 low, high;
};

/// Points that can be marked and searched. The points must outlive the tree; finite, at least one.
class PointTree {
 public:
  /// No point is marked. O(n log n).
  explicit PointTree(std::span<const Point2> points);

  bool is_marked(std::uint32_t i) const { return marks_[i] != 0; }
  /// O(log n).
  void set_marked(std::uint32_t i, bool marked);

  /// True if `test(i)` holds for a marked point i. Boxes of which `may_hold(box)` is false are
  /// passed over with all their points. The order of the calls is not specified.
  template <class MayHold, class Test>
  bool any_marked(const MayHold& may_hold, const Test& test) const {
    return any_below(0, may_hold, test);
  }

 private:
  struct Node {
    Box2 box;
    std::uint32_t first, end;  ///< its run of order_
    std::uint32_t parent;
    std::uint32_t right = 0;  ///< second child; the first one is the next node; 0: a leaf
    std::uint32_t marked = 0;
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t end, std::uint32_t parent);
  Box2 box_of(std::uint32_t first, std::uint32_t end) const;

  template <class MayHold, class Test>
  bool any_below(std::uint32_t at, const MayHold& may_hold, const Test& test) const {
    const Node& node = nodes_[at];
    if (node.marked == 0 || !may_hold(node.box)) return false;
    if (node.right != 0) {
      return any_below(at + 1, may_hold, test) || any_below(node.right, may_hold, test);
    }
    for (std::uint32_t slot = node.first; slot < node.end; ++slot) {
      if (is_marked(order_[slot]) && test(order_[slot])) return true;
    }
    return false;
  }

  std::span<const Point2> points_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> leaf_of_;
  std::vector<std::uint8_t> marks_;
  std::vector<Node> nodes_;
};

}  // namespace strahl
