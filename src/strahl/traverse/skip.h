// traverse/skip.h - depth first through a tree of planes without a stack, by skip pointers.
//
// Source: skip pointers over boxes [Smits1998], here over the cells of a kd-tree. In depth-first
//   order what follows a leaf is the upper side of one of the planes around it. Nothing remembers
//   whether the ray enters that, so it is asked: every upper subtree has a gate, the box of its
//   cell and where the subtree ends.
// Differs: there every node is tested against its box. Here an interval is carried down as by
//   walk(), one plane a step, and a gate is asked only when it is reached from behind; where only
//   the upper side is entered, what is below is jumped over.
// Order: below before above, whatever the direction of the ray. Any order serves any_hit, all_hits
//   and count_hits. closest_hit visits with it, too, skipping what begins beyond the best hit: same
//   answers, more steps for rays that descend.
// Layout: the k-th leaf is followed by the k-th upper subtree, so gates have no index: leaves
//   passed are counted. A subtree of n nodes has (n + 1) / 2 leaves.
#pragma once

#include <strahl/traverse/plane.h>

namespace strahl {

/// The cell of an upper subtree, rounded outward, and the node behind the subtree.
struct alignas(32) Gate {
  std::array<float, 3> lo, hi;
  std::uint32_t end;

  bool operator==(const Gate&) const = default;
};
static_assert(sizeof(Gate) == 32);

/// gate(k): of the subtree behind the k-th leaf. size(): number of nodes.
template <class T>
concept GatedTree = PlaneTree<T> && requires(const T& tree, std::uint32_t number) {
  { tree.gate(number) } -> std::same_as<const Gate&>;
  { tree.size() } -> std::same_as<std::uint32_t>;
};

/// Where a depth-first traversal is, and how many leaves it has passed or jumped over.
struct SkipPlace {
  std::uint32_t node, leaves;
  Interval span;
};

/// To the first leaf below the place that the ray enters. The ray must enter the place.
template <GatedTree Tree, class C>
void descend(const Tree& tree, const PreparedRay& ray, SkipPlace& at, C& counters) {
  while (!tree.is_leaf(at.node)) {
    counters.traversal_step();
    const PlaneNodes plane = tree.plane(at.node);
    std::array<NodeVisit, 2> child;
    const int count = cross_plane(ray, plane, at.span, child.data());
    const NodeVisit& next = child[count == 2 && ray.negative[plane.axis] ? 1 : 0];
    if (next.node == plane.above) at.leaves += (plane.above - at.node) / 2;
    at.node = next.node, at.span = next.span;
  }
}

/// From behind a leaf to the next upper subtree that the ray enters in time; false at the end.
template <GatedTree Tree, class Q, class C>
bool next_gate(const Tree& tree, const PreparedRay& ray, const Interval& whole, const Q& query,
               SkipPlace& at, C& counters) {
  while (at.node < tree.size()) {
    const Gate& gate = tree.gate(at.leaves - 1);
    counters.volume_tests(1);
    at.span = clip_to_box(ray, {gate.lo[0], gate.lo[1], gate.lo[2]},
                          {gate.hi[0], gate.hi[1], gate.hi[2]}, whole);
    if (at.span.t_enter <= at.span.t_exit && may_hit_before(at.span.t_enter, query.t_max()))
      return true;
    at.leaves += (gate.end - at.node + 1) / 2;
    at.node = gate.end;
  }
  return false;
}

/// Offers to the query every hit of the ray that it may want. Tree must not be empty.
template <GatedTree Tree, class Prims, class Q, class C>
void walk_by_skips(const Tree& tree, Prims& prims, const PreparedRay& ray, Q& query, C& counters) {
  const NodeVisit root = tree.enter(ray);
  counters.volume_tests(1);
  if (root.span.t_enter > root.span.t_exit) return;
  SkipPlace at{root.node, 0, root.span};
  do {
    descend(tree, ray, at, counters);
    if (may_hit_before(at.span.t_enter, query.t_max()) &&
        visit_references(tree, at.node, prims, ray, query, counters))
      return;
    ++at.node, ++at.leaves;
  } while (next_gate(tree, ray, root.span, query, at, counters));
}

}  // namespace strahl
