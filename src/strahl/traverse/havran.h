// traverse/havran.h - front to back through a tree of planes by coordinates instead of parameters.
//
// Source: [Havran2000], traversal TA^B_rec. Where a ray enters and leaves a node is kept as points,
//   which are compared with the plane; a parameter is computed only where the ray crosses it. The
//   point of a crossing is where the near node is left and the far one entered: one stack entry.
// Differs: Havran's comparisons send a ray that touches a plane to one side. Here points have a
//   slack, and a touched plane is entered on both sides, so every closed cell that holds a point of
//   the ray is visited (proof below). Where the near side is left later than the far one is entered
//   - rays in the plane, or widened for instances - the crossing is two points: the later one waits
//   without a node. Coordinates are mirrored so that every ray ascends on all axes.
// Why nothing is missed: let x(t) be a point of the ray whose hit X lies in a closed cell, |X - x|
//   <= w, the widening, and o, d origin and direction. Entry points are, up to rounding, not beyond
//   x(t) on any axis and exit points not before it: parameters order points of a ray alike on all
//   axes, and plane_first and plane_last are w early and late; on the axis of the plane itself the
//   point is put onto the plane, which bounds X. Parameters have relative errors below 2^-51 and
//   points are two roundings of them, so with |o| + |t d| <= r coordinates are off by less than
//   2^-50 r; slack is w + 2^-48 r with r of the last point of the ray.
#pragma once

#include <cmath>

#include <strahl/traverse/plane.h>

namespace strahl {

/// A parameter of a ray and the point there, mirrored.
struct RayPoint {
  double t;
  Vec3d at;
};

/// A ray that ascends on every axis, and how far off its points may be up to t_exit.
class MirroredRay {
 public:
  MirroredRay(const PreparedRay& ray, double t_exit) {
    for (int axis = 0; axis < 3; ++axis) {
      sign_[axis] = ray.negative[axis] ? -1.0 : 1.0;
      org_[axis] = sign_[axis] * ray.org[axis];
      dir_[axis] = std::abs(ray.dir[axis]);
      slack_[axis] = 2 * kPlaneMargin * (std::abs(ray.org[axis]) + t_exit * dir_[axis]) +
                     std::abs(ray.near_org[axis] - ray.org[axis]);
    }
  }
  double mirrored(int axis, double plane) const { return sign_[axis] * plane; }
  RayPoint point(double t) const { return {t, org_ + t * dir_}; }
  /// The point at t, on a (mirrored) plane.
  RayPoint point(double t, int axis, double plane) const {
    RayPoint p = point(t);
    p.at[axis] = plane;
    return p;
  }
  bool may_be_before(const RayPoint& p, int axis, double plane) const {
    return p.at[axis] - slack_[axis] <= plane;
  }
  bool may_be_behind(const RayPoint& p, int axis, double plane) const {
    return p.at[axis] + slack_[axis] >= plane;
  }

 private:
  Vec3d sign_, org_, dir_, slack_;
};

/// The crossings ahead of a ray, nearest last: each is the exit of what is visited, and the entry
/// of the node that waits there, if one does.
template <int kMaxDepth>
class Crossings {
 public:
  static constexpr std::uint32_t kNoNode = ~0u;
  struct Crossing {
    std::uint32_t node;
    RayPoint point;
  };

  explicit Crossings(const RayPoint& end) { push(kNoNode, end); }
  const RayPoint& exit() const { return waiting_[count_ - 1].point; }
  void push(std::uint32_t node, const RayPoint& point) { waiting_[count_++] = {node, point}; }
  /// The next node that waits; kNoNode when none does.
  Crossing pop() {
    while (--count_ > 0)
      if (waiting_[count_].node != kNoNode) return waiting_[count_];
    return {kNoNode, {}};
  }

 private:
  std::array<Crossing, 2 * std::size_t{kMaxDepth} + 1> waiting_;
  std::size_t count_ = 0;
};

/// Lets the far node wait behind a plane that is met between `enter` and the exit.
template <int kMaxDepth>
void push_crossing(const PreparedRay& ray, const MirroredRay& mirror, const PlaneNodes& at,
                   const RayPoint& enter, Crossings<kMaxDepth>& ahead) {
  const double t_exit = ahead.exit().t, plane = mirror.mirrored(at.axis, at.plane);
  double first = ray.plane_first(at.axis, at.plane), last = ray.plane_last(at.axis, at.plane);
  first = first > enter.t ? first : enter.t;  // NaN: the whole interval
  first = first < t_exit ? first : t_exit;
  last = last < t_exit ? last : t_exit;
  last = last > enter.t ? last : enter.t;
  ahead.push(ray.negative[at.axis] ? at.below : at.above, mirror.point(first, at.axis, plane));
  if (last != first) ahead.push(Crossings<kMaxDepth>::kNoNode, mirror.point(last, at.axis, plane));
}

/// Offers to the query every hit of the ray that it may want. Tree must not be empty.
template <PlaneTree Tree, class Prims, class Q, class C>
void walk_by_points(const Tree& tree, Prims& prims, const PreparedRay& ray, Q& query, C& counters) {
  using Ahead = Crossings<Tree::kMaxDepth>;
  const NodeVisit root = tree.enter(ray);
  counters.volume_tests(1);
  if (root.span.t_enter > root.span.t_exit) return;
  const MirroredRay mirror(ray, root.span.t_exit);
  Ahead ahead(mirror.point(root.span.t_exit));
  typename Ahead::Crossing at{root.node, mirror.point(root.span.t_enter)};
  for (; at.node != Ahead::kNoNode; at = ahead.pop()) {
    if (!may_hit_before(at.point.t, query.t_max())) continue;
    while (!tree.is_leaf(at.node)) {
      counters.traversal_step();
      const PlaneNodes plane = tree.plane(at.node);
      const double position = mirror.mirrored(plane.axis, plane.plane);
      const bool from_above = ray.negative[plane.axis];
      if (!mirror.may_be_before(at.point, plane.axis, position)) {
        at.node = from_above ? plane.below : plane.above;
        continue;
      }
      if (mirror.may_be_behind(ahead.exit(), plane.axis, position))
        push_crossing(ray, mirror, plane, at.point, ahead);
      at.node = from_above ? plane.above : plane.below;
    }
    if (visit_references(tree, at.node, prims, ray, query, counters)) return;
  }
}

}  // namespace strahl
