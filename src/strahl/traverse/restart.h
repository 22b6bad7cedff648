// traverse/restart.h - front to back through a binary tree without a stack, from the root again for
// every leaf.
//
// Source: restart trail [Laine2010]: a bit per level of the tree says whether the far child is due
//   where both children are entered. Visits the leaves that walk() visits, in its order, in depth
//   times the steps: meant for the few leaves around a point.
#pragma once

#include <bit>

#include <strahl/traverse/walk.h>

namespace strahl {

/// Offers to the query every hit in leaves that the ray meets while it is at `root`. True when it
/// stops the traversal.
template <WalkableTree Tree, class Prims, class Q, class C>
bool restart(const Tree& tree, const NodeVisit& root, Prims& prims, const PreparedRay& ray,
             Q& query, C& counters) {
  static_assert(Tree::kMaxChildren == 2 && Tree::kMaxDepth <= 64);
  for (std::uint64_t trail = 0;;) {
    NodeVisit at = root;
    std::uint64_t waiting = 0;  // levels where the near child was taken and the far one is due
    for (std::uint64_t level = 1; !tree.is_leaf(at.node); level <<= 1) {
      counters.traversal_step();
      std::array<NodeVisit, 2> child;
      const bool both = tree.expand(ray, at, child.data(), counters) == 2;
      const bool is_far = both && (trail & level) != 0;
      if (both && !is_far) waiting |= level;
      at = child[is_far ? 1 : 0];
    }
    if (may_hit_before(at.span.t_enter, query.t_max()) &&
        visit_references(tree, at.node, prims, ray, query, counters))
      return true;
    if (waiting == 0) return false;
    const std::uint64_t deepest = std::bit_floor(waiting);
    trail = (trail & (deepest - 1)) | deepest;
  }
}

}  // namespace strahl
