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
    children[0] = {0, at.span};
    int count = 1;
    for (int k = 0; k < kAxes; ++k) count = cut(ray, block, k, children, count);
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
  /// Cuts the parts so far by the plane of one axis: near and far parts of each, in order.
  int cut(const PreparedRay& ray, std::uint32_t block, int k, NodeVisit* parts, int count) const {
    const int axis = tree_.axes()[k];
    const double end = tree_.end(block)[axis], begin = tree_.begin(block)[axis];
    const bool neg = ray.negative[axis];
    const double first = ray.plane_first(axis, neg ? end : begin) * (1.0 - kPlaneMargin);
    const double last = ray.plane_last(axis, neg ? begin : end) * (1.0 + kPlaneMargin);
    std::array<NodeVisit, kMaxChildren> whole;
    for (int i = 0; i < count; ++i) whole[static_cast<std::size_t>(i)] = parts[i];
    int made = 0;
    for (int i = 0; i < count; ++i) {
      const NodeVisit& part = whole[static_cast<std::size_t>(i)];
      // Comparisons hold for NaN. Parameters below 0 may keep the wrong side of the margin:
      // intervals begin at 0.
      if (!(part.span.t_enter > last)) {
        const double t_exit = last < part.span.t_exit ? last : part.span.t_exit;
        parts[made++] = {part.node << 1, {part.span.t_enter, t_exit}};
      }
      if (!(part.span.t_exit < first)) {
        const double t_enter = first > part.span.t_enter ? first : part.span.t_enter;
        parts[made++] = {part.node << 1 | 1u, {t_enter, part.span.t_exit}};
      }
    }
    return made;
  }

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
