#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <strahl/build/kd_policy.h>

namespace strahl {
namespace {

/// The cell without a rim in which bounds of clipped primitives may be off by rounding; axes along
/// which the cell is flat stay as they are.
Aabb inner_part(const Aabb& cell, double largest) {
  const double rim = 1024 * 0x1p-53 * largest;
  Aabb core = cell;
  for (int axis = 0; axis < 3; ++axis) {
    if (cell.lo[axis] == cell.hi[axis]) continue;
    core.lo[axis] += rim, core.hi[axis] -= rim;
  }
  return core;
}

/// Whether the box meets the interior of the cell, the whole cell along axes where it is flat.
bool meets_interior(const Aabb& cell, const Aabb& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_flat = cell.lo[axis] == cell.hi[axis];
    const bool meets = is_flat ? box.lo[axis] <= cell.hi[axis] && cell.lo[axis] <= box.hi[axis]
                               : box.lo[axis] < cell.hi[axis] && cell.lo[axis] < box.hi[axis];
    if (!meets) return false;
  }
  return true;
}

/// Walks the tree with the primitives that may lie in each cell.
class KdChecker {
 public:
  KdChecker(const KdArrays& tree, const KdCheck& check, const PrimitiveSource& source)
      : tree_(tree),
        check_(check),
        source_(source),
        largest_(check.root.is_empty()
                     ? 0.0
                     : std::max(norm_max(check.root.lo), norm_max(check.root.hi))) {}

  void run() {
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < source_.size(); ++i)
      if (!source_.bounds(i).is_empty()) all.push_back(i);
    is_referenced_.assign(source_.size(), false);
    const double cost = visit(check_.root, all, 0);
    demand(next_node_ == tree_.nodes.size(), "nodes beyond the last leaf");
    demand(next_reference_ == tree_.references.size(), "references beyond the last leaf");
    for (const std::uint32_t i : all) demand(is_referenced_[i], "a primitive is in no leaf");
    const BuildReport& report = check_.report;
    demand(leaves_ == report.leaves && empty_ == report.empty_leaves, "report: leaves");
    demand(total_references_ == report.references, "report: references");
    demand(deepest_ == report.depth, "report: depth");
    demand(next_node_ == report.nodes, "report: nodes");
    const double reported = report.sah_cost * check_.cost.traverse;
    demand(std::abs(cost - reported) <= 1e-6 * cost, "report: SAH cost");
  }

 private:
  void demand(bool holds, const char* broken) const {
    if (!holds) throw std::logic_error(std::string(check_.name) + ": " + broken);
  }

  /// Checks the subtree that begins at next_node_; returns its cost per line that crosses it.
  double visit(const Aabb& cell, const std::vector<std::uint32_t>& candidates, int depth) {
    demand(next_node_ < tree_.nodes.size(), "a child beyond the last node");
    const KdNode& node = tree_.nodes[next_node_++];
    demand(depth <= check_.max_depth, "a node is too deep");
    if (node.is_leaf()) return visit_leaf(node, cell, candidates, depth);
    if (node.is_filter()) return visit_filter(node, cell, candidates, depth);
    const int axis = node.axis();
    demand(cell.lo[axis] < node.plane() && node.plane() < cell.hi[axis],
           "a split plane is not strictly inside its cell");
    Aabb left = cell, right = cell;
    left.hi[axis] = right.lo[axis] = node.plane();
    const double left_cost = visit(left, inside(left, candidates), depth + 1);
    demand(next_node_ == node.right(), "a right child is not where its parent says");
    const double right_cost = visit(right, inside(right, candidates), depth + 1);
    const double whole = cell.half_area();
    return check_.cost.traverse + sah_share(left.half_area(), whole) * left_cost +
           sah_share(right.half_area(), whole) * right_cost;
  }

  /// The left subtree alone holds its primitives; the rest is checked without them.
  double visit_filter(const KdNode& node, const Aabb& cell,
                      const std::vector<std::uint32_t>& candidates, int depth) {
    demand(check_.may_filter, "a split plane is NaN");
    demand(node.right() >= next_node_ && node.right() < tree_.nodes.size() &&
               !tree_.nodes[node.right()].is_leaf() && !tree_.nodes[node.right()].is_filter(),
           "a filter is not followed by a plane");
    const std::vector<std::uint32_t> filtered = references_of(next_node_, node.right());
    std::vector<std::uint32_t> inside, rest;
    for (const std::uint32_t i : candidates)
      (std::binary_search(filtered.begin(), filtered.end(), i) ? inside : rest).push_back(i);
    const double cost = visit(cell, inside, depth + 1);
    demand(next_node_ == node.right(), "a right child is not where its parent says");
    const double rest_cost = visit(cell, rest, depth + 1);
    for (const std::uint32_t i : references_of(node.right(), next_node_))
      demand(!std::binary_search(filtered.begin(), filtered.end(), i),
             "an oversized primitive is also in the rest");
    return cost + rest_cost;
  }

  /// Sorted references of the leaves among nodes [first, last).
  std::vector<std::uint32_t> references_of(std::size_t first, std::size_t last) const {
    std::vector<std::uint32_t> all;
    for (std::size_t i = first; i < last; ++i) {
      const KdNode& node = tree_.nodes[i];
      if (!node.is_leaf()) continue;
      demand(node.count() < 2 || node.first() + node.count() <= tree_.references.size(),
             "a leaf's references are out of range");
      const auto references = node.references(tree_.references);
      all.insert(all.end(), references.begin(), references.end());
    }
    std::sort(all.begin(), all.end());
    return all;
  }

  double visit_leaf(const KdNode& node, const Aabb& cell,
                    const std::vector<std::uint32_t>& candidates, int depth) {
    ++leaves_;
    empty_ += node.count() == 0;
    total_references_ += node.count();
    deepest_ = std::max(deepest_, static_cast<std::uint64_t>(depth));
    if (node.count() > 1) {
      demand(node.first() == next_reference_, "leaves do not share out the references in order");
      next_reference_ += node.count();
      demand(next_reference_ <= tree_.references.size(), "a leaf's references are out of range");
    }
    check_references(node.references(tree_.references), cell, candidates);
    return sah_leaf_cost(check_.cost, node.count());
  }

  void check_references(std::span<const std::uint32_t> references, const Aabb& cell,
                        const std::vector<std::uint32_t>& candidates) {
    for (std::size_t i = 0; i < references.size(); ++i) {
      demand(references[i] < source_.size(), "a reference is out of range");
      demand(i == 0 || references[i - 1] < references[i], "references of a leaf do not ascend");
      const Aabb box = source_.bounds(references[i]);
      demand(!box.is_empty() && box.overlaps(cell), "a leaf refers to what is not in it");
      is_referenced_[references[i]] = true;
    }
    const Aabb core = inner_part(cell, largest_);
    if (core.is_empty()) return;
    for (const std::uint32_t i : candidates) {
      if (std::binary_search(references.begin(), references.end(), i)) continue;
      demand(source_.clip(i, core).is_empty(), "a primitive inside a leaf is not referred to");
    }
  }

  std::vector<std::uint32_t> inside(const Aabb& cell, const std::vector<std::uint32_t>& from) {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t i : from)
      if (meets_interior(cell, source_.bounds(i))) found.push_back(i);
    return found;
  }

  const KdArrays& tree_;
  const KdCheck& check_;
  const PrimitiveSource& source_;
  double largest_;
  std::vector<bool> is_referenced_;
  std::size_t next_node_ = 0, next_reference_ = 0;
  std::uint64_t leaves_ = 0, empty_ = 0, total_references_ = 0, deepest_ = 0;
};

}  // namespace

void validate_kd_tree(const KdArrays& tree, const KdCheck& check, const PrimitiveSource& source) {
  KdChecker(tree, check, source).run();
}

}  // namespace strahl
