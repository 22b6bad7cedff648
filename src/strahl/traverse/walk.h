// traverse/walk.h - the one loop over all trees, front to back with a stack.
//
// A tree supplies expansion, not a loop: which children a ray may enter, nearest first, each with
// the conservative interval in which it is inside. A subtree is skipped only when its entry,
// lowered by the hit margin, lies beyond what the query still wants; a tie is never lost.
// Invariants: the stack never overflows: a tree of depth D and arity A keeps at most D * (A - 1)
// waiting children, and Tree::kMaxDepth bounds D.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <span>

#include <strahl/traverse/leaf.h>

namespace strahl {

/// A subtree to visit and where the ray may be inside it.
struct NodeVisit {
  std::uint32_t node;
  Interval span;
};

/// What walk() needs of a tree. enter(): the root's visit, its span empty on a miss. expand():
/// writes the children to visit, nearest first, and returns their number.
template <class T>
concept WalkableTree = requires(const T& tree, const PreparedRay& ray, const NodeVisit& at,
                                NodeVisit* children, std::uint32_t node) {
  { T::kMaxChildren } -> std::convertible_to<int>;
  { T::kMaxDepth } -> std::convertible_to<int>;
  { tree.enter(ray) } -> std::same_as<NodeVisit>;
  { tree.is_leaf(node) } -> std::same_as<bool>;
  { tree.references(node) } -> std::same_as<std::span<const std::uint32_t>>;
};

/// A tree whose inner nodes, too, may have references, tested before their children.
template <class T>
concept HasInnerReferences = requires(const T& tree, std::uint32_t node) {
  { tree.inner_references(node) } -> std::same_as<std::span<const std::uint32_t>>;
};

/// Tests what a node refers to. True when the query stops the traversal.
template <WalkableTree Tree, class Prims, class Q, class C>
bool visit_references(const Tree& tree, std::uint32_t node, Prims& prims, const PreparedRay& ray,
                      Q& query, C& counters) {
  if (tree.is_leaf(node)) return test_leaf(tree.references(node), prims, ray, query, counters);
  if constexpr (HasInnerReferences<Tree>)
    return test_references(tree.inner_references(node), prims, ray, query, counters);
  return false;
}

/// Offers to the query every hit of the ray that it may want. Tree must not be empty.
template <WalkableTree Tree, class Prims, class Q, class C>
void walk(const Tree& tree, Prims& prims, const PreparedRay& ray, Q& query, C& counters) {
  constexpr std::size_t kStack = std::size_t{Tree::kMaxDepth} * (Tree::kMaxChildren - 1) + 1;
  std::array<NodeVisit, kStack> waiting;
  std::size_t count = 0;
  NodeVisit at = tree.enter(ray);
  counters.volume_tests(1);
  if (at.span.t_enter > at.span.t_exit) return;
  for (;;) {
    if (may_hit_before(at.span.t_enter, query.t_max())) {
      if (visit_references(tree, at.node, prims, ray, query, counters)) return;
      if (!tree.is_leaf(at.node)) {
        counters.traversal_step();
        std::array<NodeVisit, Tree::kMaxChildren> child;
        const int entered = tree.expand(ray, at, child.data(), counters);
        for (int i = entered - 1; i > 0; --i) waiting[count++] = child[static_cast<std::size_t>(i)];
        counters.waiting(count);
        if (entered > 0) {
          at = child[0];
          continue;
        }
      }
    }
    if (count == 0) return;
    at = waiting[--count];
  }
}

}  // namespace strahl
