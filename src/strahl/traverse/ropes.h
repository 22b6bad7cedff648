// traverse/ropes.h - from leaf to leaf of a tree of planes by links through the faces of cells,
// without a stack.
//
// Source: [MacDonaldBooth1990], ropes pushed down after [HavranBittnerZara1998]; one chain of
// leaves
//   per ray as in [Popov2007].
// Layout: a leaf knows its cell and, per face, the smallest node on the other side of the whole
//   face; from there the ray is followed down to one leaf.
// Differs: a chain visits one cell where a ray passes several at once - at edges and corners, along
//   planes, from a surface that a plane lies in. A step is taken only when it is certain: the ray
//   leaves by one face, all others later, and on the other side no plane is touched meanwhile.
//   Otherwise restart() visits all cells around until the planes are left behind - to the end when
//   the ray runs in one - and the chain goes on from the root.
// Why nothing is missed: while a plane certainly is not touched the ray is on one side of it, and
//   every plane is: those tested on the way down, and those around the node a rope leads to, which
//   lie no nearer than the faces of the leaf it comes from. So all closed cells that the ray meets
//   up to the end of at.span are visited when the next step begins.
#pragma once

#include <cmath>

#include <strahl/traverse/plane.h>
#include <strahl/traverse/restart.h>

namespace strahl {

/// A cell, outer faces rounded outward, and what lies behind its faces: 2 * axis + (1 if upper).
struct RopedCell {
  static constexpr std::uint32_t kNoRope = ~0u;
  std::array<float, 6> face;
  std::array<std::uint32_t, 6> rope;  ///< kNoRope at the border of the scene

  bool operator==(const RopedCell&) const = default;
};
static_assert(sizeof(RopedCell) == 48);

/// cell(leaf): of a leaf node.
template <class T>
concept RopedTree = PlaneTree<T> && requires(const T& tree, std::uint32_t leaf) {
  { tree.cell(leaf) } -> std::same_as<const RopedCell&>;
};

/// The next step of a chain: into a node, while the ray crosses a face. When it is not certain that
/// the ray is nowhere else meanwhile, `until` is when that is over.
struct RopeStep {
  NodeVisit at;
  bool is_certain = true;
  double until = 0.0;
};

/// When a plane that is touched during `span` is certainly left behind; infinite if never.
inline double plane_left_behind(const PreparedRay& ray, int axis, double plane,
                                const Interval& span) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const double last = touch_plane(ray, axis, plane).t_exit;
  if (!(last < kInf)) return kInf;
  return std::nextafter(last > span.t_exit ? last : span.t_exit, kInf);
}

/// Out of a cell that the ray is certainly in, by the face it leaves through first. The node is
/// kNoRope when it leaves by none that leads on.
inline RopeStep leave_cell(const PreparedRay& ray, const RopedCell& cell) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  double others = kInf;
  int axis = 0;
  RopeStep step{{RopedCell::kNoRope, {kInf, kInf}}};
  for (int a = 0; a < 3; ++a) {
    const std::size_t face = 2 * static_cast<std::size_t>(a) + (ray.negative[a] ? 0 : 1);
    if (cell.rope[face] == RopedCell::kNoRope) continue;
    const Interval touch = touch_plane(ray, a, static_cast<double>(cell.face[face]));
    if (touch.t_enter < step.at.span.t_enter) {
      others = step.at.span.t_enter;
      step.at = {cell.rope[face], touch}, axis = a;
    } else if (touch.t_enter < others) {
      others = touch.t_enter;
    }
  }
  if (step.at.node == RopedCell::kNoRope || others > step.at.span.t_exit) return step;
  const std::size_t face = 2 * static_cast<std::size_t>(axis) + (ray.negative[axis] ? 0 : 1);
  step.is_certain = false;
  step.until = plane_left_behind(ray, axis, static_cast<double>(cell.face[face]), step.at.span);
  return step;
}

/// Down to the leaf that the ray is in, unless it touches a plane on the way.
template <RopedTree Tree, class C>
void follow(const Tree& tree, const PreparedRay& ray, RopeStep& step, C& counters) {
  while (step.is_certain && !tree.is_leaf(step.at.node)) {
    counters.traversal_step();
    const PlaneNodes plane = tree.plane(step.at.node);
    std::array<NodeVisit, 2> child;
    if (cross_plane(ray, plane, step.at.span, child.data()) == 2) {
      step.is_certain = false;
      step.until = plane_left_behind(ray, plane.axis, plane.plane, step.at.span);
    }
    step.at.node = child[0].node;
  }
}

/// Offers to the query every hit of the ray that it may want. Tree must not be empty.
template <RopedTree Tree, class Prims, class Q, class C>
void walk_by_ropes(const Tree& tree, Prims& prims, const PreparedRay& ray, Q& query, C& counters) {
  const NodeVisit root = tree.enter(ray);
  counters.volume_tests(1);
  if (root.span.t_enter > root.span.t_exit) return;
  const double end = root.span.t_exit;
  RopeStep step{{root.node, {root.span.t_enter, root.span.t_enter}}};
  while (step.at.span.t_enter <= end && may_hit_before(step.at.span.t_enter, query.t_max())) {
    follow(tree, ray, step, counters);
    if (step.is_certain) {
      if (visit_references(tree, step.at.node, prims, ray, query, counters)) return;
      counters.volume_tests(1);
      step = leave_cell(ray, tree.cell(step.at.node));
    } else {
      const double until = step.until < end ? step.until : end;
      const NodeVisit around{root.node, {step.at.span.t_enter, until}};
      if (restart(tree, around, prims, ray, query, counters) || until == end) return;
      step = {{root.node, {until, until}}};
    }
  }
}

}  // namespace strahl
