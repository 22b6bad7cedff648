// traverse/octants.h - how rays pass cells that are divided on two or three axes at once.
//
// Source: [Revelles2000]: the parameters of the planes say which children are met and in which
//   order; neighbours by way of the nearest common ancestor [Samet1989].
// Which children: the ray is in the half it comes from until it has certainly left it (plane_last,
//   raised by kPlaneMargin), and in the other one from when it may have entered it (plane_first,
//   lowered). A child is the common part of one half per axis; it is met while all these intervals
//   and that of its parent have a common parameter. Every closed child that a point of the ray lies
//   in is met: on planes, at edges and corners, or running inside a plane (NaN) all that touch.
// Order: for cells that do not overlap a ray only ever changes to the farther half of an axis, so
//   children by ascending place, near halves first, are met front to back. Enlarged cells may be
//   met out of order: no matter, each is compared by its own entry.
// Differs: parameters are computed anew from the planes, so their error does not grow with depth.
// Thread safety: pure.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <strahl/traverse/climb.h>
#include <strahl/traverse/walk.h>

namespace strahl {

/// The part of a ray's interval in which it may be inside a cell; by the arithmetic of expand(), so
/// cutting plane by plane or all at once gives the same bits.
inline Interval clip_to_cell(const PreparedRay& ray, const Aabb& cell) {
  Interval in{ray.t_enter, ray.t_exit};
  for (int axis = 0; axis < 3; ++axis) {
    const bool neg = ray.negative[axis];
    const double first =
        ray.plane_first(axis, neg ? cell.hi[axis] : cell.lo[axis]) * (1.0 - kPlaneMargin);
    const double last =
        ray.plane_last(axis, neg ? cell.lo[axis] : cell.hi[axis]) * (1.0 + kPlaneMargin);
    in.t_enter = first > in.t_enter ? first : in.t_enter;
    in.t_exit = last < in.t_exit ? last : in.t_exit;
  }
  return in;
}

/// A tree of cells (see build/octants.h) as walk() and climb() see it.
template <class Tree, int kAxes, int kDepth>
class OctantView {
 public:
  static constexpr int kMaxChildren = 1 << kAxes;
  static constexpr int kMaxDepth = kDepth;
  static constexpr std::uint32_t kRoot = 0;

  explicit OctantView(const Tree& tree) : tree_(tree) {}

  NodeVisit enter(const PreparedRay& ray) const { return {kRoot, clip_to_cell(ray, tree_.box())}; }
  bool is_leaf(std::uint32_t node) const { return tree_.is_leaf(node); }
  std::span<const std::uint32_t> references(std::uint32_t node) const {
    return tree_.references(node);
  }
  std::span<const std::uint32_t> inner_references(std::uint32_t node) const {
    return tree_.references(node);
  }

  template <class C>
  int expand(const PreparedRay& ray, const NodeVisit& at, NodeVisit* children, C&) const {
    const std::uint32_t block = tree_.node(at.node).block;
    const Crossings planes = crossings(ray, block);
    int count = 0;
    if (tree_.is_loose()) {
      const Crossings sides = outer_crossings(ray, block);
      count = combine<true>(planes, sides, at.span, children);
    } else {
      count = follow(planes, at.span, children);
      if (count == 0) count = combine<false>(planes, planes, at.span, children);
    }
    const std::uint32_t first = tree_.child(block), flip = near_child(ray);
    for (int i = 0; i < count; ++i) children[i].node = first + (children[i].node ^ flip);
    return count;
  }

  NodeVisit parent(const PreparedRay& ray, std::uint32_t node) const {
    const std::uint32_t block = tree_.block_of(node);
    return {tree_.parent(block), clip_to_cell(ray, tree_.reach(block))};
  }
  /// Place in the ray's order among the children of the same parent.
  std::uint32_t rank(const PreparedRay& ray, std::uint32_t node) const {
    return (node - tree_.child(tree_.block_of(node))) ^ near_child(ray);
  }

 private:
  /// Per divided axis, when the far half may be entered and when the near one is left.
  struct Crossings {
    std::array<double, kAxes> first, last;
  };
  static constexpr std::uint32_t far_bit(int k) { return 1u << (kAxes - 1 - k); }

  Crossings crossings(const PreparedRay& ray, std::uint32_t block) const {
    return between(ray, tree_.begin(block), tree_.end(block));
  }
  /// Of enlarged cells: when the near half may be entered and when the far one is left.
  Crossings outer_crossings(const PreparedRay& ray, std::uint32_t block) const {
    return between(ray, tree_.low(block), tree_.high(block));
  }
  /// From `begin` or later to `end` or before; per axis the other way round where the ray descends.
  Crossings between(const PreparedRay& ray, const Vec3d& begin, const Vec3d& end) const {
    Crossings planes;
    for (int k = 0; k < kAxes; ++k) {
      const int axis = tree_.axes()[k];
      const bool neg = ray.negative[axis];
      // Parameters below 0 may keep the wrong side of the margin: intervals begin at 0.
      planes.first[static_cast<std::size_t>(k)] =
          ray.plane_first(axis, neg ? end[axis] : begin[axis]) * (1.0 - kPlaneMargin);
      planes.last[static_cast<std::size_t>(k)] =
          ray.plane_last(axis, neg ? begin[axis] : end[axis]) * (1.0 + kPlaneMargin);
    }
    return planes;
  }

  /// The children one after the other, where no two planes are crossed at once: from that in which
  /// the ray enters to the next by the plane crossed next. 0 where that is not certain, NaN
  /// included.
  int follow(const Crossings& planes, const Interval& span, NodeVisit* children) const {
    std::array<std::size_t, kAxes> next;
    std::size_t crossed = 0;
    std::uint32_t place = 0;
    for (std::size_t k = 0; k < kAxes; ++k) {
      if (planes.last[k] < span.t_enter) {
        place |= far_bit(static_cast<int>(k));
      } else if (!(span.t_exit < planes.first[k])) {
        if (!(span.t_enter < planes.first[k])) return 0;
        std::size_t i = crossed++;
        for (; i > 0 && planes.first[k] < planes.first[next[i - 1]]; --i) next[i] = next[i - 1];
        next[i] = k;
      }
    }
    for (std::size_t i = 1; i < crossed; ++i)
      if (!(planes.last[next[i - 1]] < planes.first[next[i]])) return 0;
    double t_enter = span.t_enter;
    for (std::size_t i = 0; i < crossed; ++i) {
      const double last = planes.last[next[i]];
      children[i] = {place, {t_enter, last < span.t_exit ? last : span.t_exit}};
      place |= far_bit(static_cast<int>(next[i])), t_enter = planes.first[next[i]];
    }
    children[crossed] = {place, {t_enter, span.t_exit}};
    return static_cast<int>(crossed) + 1;
  }

  /// All children whose intervals have a common parameter. Comparisons hold for NaN.
  template <bool kLoose>
  int combine(const Crossings& planes, const Crossings& sides, const Interval& span,
              NodeVisit* children) const {
    int count = 0;
    for (std::uint32_t place = 0; place < kMaxChildren; ++place) {
      Interval in = span;
      for (int k = 0; k < kAxes; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        const bool is_far = (place & far_bit(k)) != 0;
        if (is_far || kLoose) begin_at(is_far ? planes.first[axis] : sides.first[axis], in);
        if (!is_far || kLoose) end_at(is_far ? sides.last[axis] : planes.last[axis], in);
      }
      if (!(in.t_enter > in.t_exit)) children[count++] = {place, in};
    }
    return count;
  }
  static void begin_at(double t, Interval& in) { in.t_enter = t > in.t_enter ? t : in.t_enter; }
  static void end_at(double t, Interval& in) { in.t_exit = t < in.t_exit ? t : in.t_exit; }

  /// Place of the child in which all halves are near.
  std::uint32_t near_child(const PreparedRay& ray) const {
    std::uint32_t place = 0;
    for (int k = 0; k < kAxes; ++k)
      place = place << 1 | static_cast<std::uint32_t>(ray.negative[tree_.axes()[k]]);
    return place;
  }

  const Tree& tree_;
};

/// Offers to the query every hit of the ray that it may want. Tree must not be empty.
/// @param neighbours climb from leaf to leaf; else walk down from the root
template <int kAxes, int kDepth, class Tree, class Prims, class Q, class C>
void trace_octants(const Tree& tree, bool neighbours, Prims& prims, const PreparedRay& ray,
                   Q& query, C& counters) {
  const OctantView<Tree, kAxes, kDepth> view(tree);
  if (neighbours)
    climb(view, prims, ray, query, counters);
  else
    walk(view, prims, ray, query, counters);
}

}  // namespace strahl
