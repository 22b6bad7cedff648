// structures/kd_tree/kd_links.h - what traversals without a stack need besides nodes: gates of
// upper subtrees (traverse/skip.h), ropes between cells (traverse/ropes.h).
//
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/math/aabb.h>
#include <strahl/structures/kd_tree/kd_nodes.h>
#include <strahl/traverse/ropes.h>
#include <strahl/traverse/skip.h>

namespace strahl {

/// Memory: gates take 16 bytes per node, ropes 28.
struct KdLinks {
  std::vector<Gate> gates;           ///< k: of the subtree that follows the k-th leaf
  std::vector<RopedCell> cells;      ///< of leaves, depth first
  std::vector<std::uint32_t> place;  ///< of a node: leaves before it, a leaf's place in cells

  std::size_t bytes() const {
    return gates.capacity() * sizeof(Gate) + cells.capacity() * sizeof(RopedCell) +
           place.capacity() * sizeof(std::uint32_t);
  }
};

/// O(nodes). Throws Error{resource}, Error{cancelled}.
/// @param owned bytes that the build owns already
KdLinks make_gates(const KdNodes& nodes, const Aabb& root, std::uint64_t owned,
                   const BuildContext& context);
/// O(nodes * depth) at most. Throws Error{resource}, Error{cancelled}.
KdLinks make_ropes(const KdNodes& nodes, const Aabb& root, std::uint64_t owned,
                   const BuildContext& context);

/// Throw std::logic_error naming the first gate that is not the cell of its subtree or does not end
/// behind it; the first rope that does not lead to the smallest node whose cell touches the whole
/// face from the other side, or is missing. O(nodes), O(nodes * depth).
void check_gates(const KdLinks& links, const KdNodes& nodes, const Aabb& root);
void check_ropes(const KdLinks& links, const KdNodes& nodes, const Aabb& root);

}  // namespace strahl
