// traverse/plane.h - which sides of an axis-perpendicular plane a ray visits, nearest first.
//
// Both sides are visited unless the plane's parameter, with the margin for its rounding, says that
// the side is certainly left before or entered after what is visited; so every closed cell that
// holds a point of the ray is visited, those on both sides of a plane that the ray touches or lies
// in (a NaN parameter) included.
// Thread safety: pure.
#pragma once

#include <strahl/traverse/walk.h>

namespace strahl {

/// A plane and the nodes on its sides.
struct PlaneNodes {
  int axis;
  double plane;
  std::uint32_t below, above;
};

/// A tree whose inner nodes are planes through their cells, with a node on either side; depth
/// first: what is below a plane follows it.
template <class T>
concept PlaneTree = WalkableTree<T> && requires(const T& tree, std::uint32_t node) {
  { tree.plane(node) } -> std::same_as<PlaneNodes>;
};

/// When the ray may begin, and when it may cease, to touch a plane. A parameter below 0 may keep
/// the wrong side of the margin: intervals begin at 0. NaN or infinite where the ray is parallel.
inline Interval touch_plane(const PreparedRay& ray, int axis, double plane) {
  return {ray.plane_first(axis, plane) * (1.0 - kPlaneMargin),
          ray.plane_last(axis, plane) * (1.0 + kPlaneMargin)};
}

/// Writes the children to visit and returns their number. The near one is on the side the ray
/// comes from. Comparisons hold for NaN. A call per step would cost a fifth of all instructions,
/// and where many loops are instantiated g++ makes it one.
[[gnu::always_inline]] inline int cross_plane(const PreparedRay& ray, const PlaneNodes& at,
                                              const Interval& span, NodeVisit* children) {
  const auto [first, last] = touch_plane(ray, at.axis, at.plane);
  const bool from_above = ray.negative[at.axis];
  int count = 0;
  if (!(span.t_enter > last)) {
    const double t_exit = last < span.t_exit ? last : span.t_exit;
    children[count++] = {from_above ? at.above : at.below, {span.t_enter, t_exit}};
  }
  if (!(span.t_exit < first)) {
    const double t_enter = first > span.t_enter ? first : span.t_enter;
    children[count++] = {from_above ? at.below : at.above, {t_enter, span.t_exit}};
  }
  return count;
}

}  // namespace strahl
