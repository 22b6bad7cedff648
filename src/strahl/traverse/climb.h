// traverse/climb.h - from each leaf to the next one by way of their nearest common ancestor,
// without a stack.
//
// Source: neighbour finding [Samet1989]. There the face through which a ray leaves a cell names the
//   next one; here the ancestor is asked which of its children the ray meets next, so a ray through
//   an edge or a corner, which leaves through several faces, goes to all the cells around it.
// Invariants: visits the nodes that walk() visits, in its order: what a tree says of a node does
//   not depend on the way to it, see Tree::parent().
#pragma once

#include <strahl/traverse/walk.h>

namespace strahl {

/// What climb() needs besides: parent(): an ancestor's visit, with the span that enter() and
/// expand() have given it; rank(): ascending in the order in which expand() writes children.
template <class T>
concept ClimbableTree = WalkableTree<T> &&
    requires(const T& tree, const PreparedRay& ray, std::uint32_t node) {
  { tree.parent(ray, node) } -> std::same_as<NodeVisit>;
  { tree.rank(ray, node) } -> std::same_as<std::uint32_t>;
};

/// The first child met that ranks at `from` or later; its node is T::kRoot when there is none.
template <ClimbableTree Tree, class C>
NodeVisit next_child(const Tree& tree, const PreparedRay& ray, const NodeVisit& parent,
                     std::uint32_t from, C& counters) {
  counters.traversal_step();
  std::array<NodeVisit, Tree::kMaxChildren> child;
  const int count = tree.expand(ray, parent, child.data(), counters);
  for (int i = 0; i < count; ++i) {
    const NodeVisit& found = child[static_cast<std::size_t>(i)];
    if (tree.rank(ray, found.node) >= from) return found;
  }
  return {Tree::kRoot, parent.span};
}

/// Offers to the query every hit of the ray that it may want. Tree must not be empty.
template <ClimbableTree Tree, class Prims, class Q, class C>
void climb(const Tree& tree, Prims& prims, const PreparedRay& ray, Q& query, C& counters) {
  NodeVisit at = tree.enter(ray);
  counters.volume_tests(1);
  if (at.span.t_enter > at.span.t_exit) return;
  for (;;) {
    NodeVisit next{Tree::kRoot, at.span};
    if (may_hit_before(at.span.t_enter, query.t_max())) {
      if (visit_references(tree, at.node, prims, ray, query, counters)) return;
      if (!tree.is_leaf(at.node)) next = next_child(tree, ray, at, 0, counters);
    }
    while (next.node == Tree::kRoot) {
      if (at.node == Tree::kRoot) return;
      const std::uint32_t rank = tree.rank(ray, at.node);
      at = tree.parent(ray, at.node);
      next = next_child(tree, ray, at, rank + 1, counters);
    }
    at = next;
  }
}

}  // namespace strahl
