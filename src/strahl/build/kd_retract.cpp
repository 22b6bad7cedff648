#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include <strahl/build/kd_retract.h>

namespace strahl {
namespace {

/// Writes nodes anew over the old ones, which they never pass. References move to their own place:
/// there can be more of them, since leaves with one hold it themselves.
class Retractor {
 public:
  Retractor(KdOutput& tree, const SahCost& cost) : tree_(tree), cost_(cost) {}

  void run(const Aabb& root) {
    visit(0, root);
    tree_.nodes.erase(tree_.nodes.begin() + static_cast<std::ptrdiff_t>(nodes_), tree_.nodes.end());
    tree_.references = std::move(references_);
  }

 private:
  /// Moves a subtree to the end of what is written; returns its cost per line that crosses it.
  double visit(std::uint32_t from, const Aabb& cell) {
    const KdNode node = tree_.nodes[from];
    if (node.is_leaf()) return move_leaf(node);
    const double leaf_cost = sah_leaf_cost(cost_, tree_.counts[from]);
    const std::size_t to = nodes_++, first_reference = references_.size();
    Aabb left = cell, right = cell;
    left.hi[node.axis()] = right.lo[node.axis()] = node.plane();
    const double whole = cell.half_area();
    double cost = cost_.traverse + sah_share(left.half_area(), whole) * visit(from + 1, left);
    const std::size_t right_child = nodes_;
    cost += sah_share(right.half_area(), whole) * visit(node.right(), right);
    if (cost >= leaf_cost) return collapse(to, first_reference);
    tree_.nodes[to] = node;
    tree_.nodes[to].link_right(right_child);
    return cost;
  }

  double move_leaf(const KdNode& node) {
    write_leaf(nodes_++, node.references(tree_.references));
    return sah_leaf_cost(cost_, node.count());
  }

  /// Makes one leaf of the nodes written behind `to`.
  double collapse(std::size_t to, std::size_t first_reference) {
    std::vector<std::uint32_t> all;
    for (std::size_t i = to + 1; i < nodes_; ++i) {
      if (!tree_.nodes[i].is_leaf()) continue;
      const auto some = tree_.nodes[i].references(references_);
      all.insert(all.end(), some.begin(), some.end());
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    nodes_ = to + 1, references_.resize(first_reference);
    write_leaf(to, all);
    return sah_leaf_cost(cost_, all.size());
  }

  void write_leaf(std::size_t to, std::span<const std::uint32_t> leaf) {
    const auto first = static_cast<std::uint32_t>(references_.size());
    const std::size_t count = leaf.size();
    if (count > 1) references_.insert(references_.end(), leaf.begin(), leaf.end());
    tree_.nodes[to] = KdNode::leaf(count == 0 ? 0 : count == 1 ? leaf.front() : first, count);
  }

  KdOutput& tree_;
  SahCost cost_;
  std::size_t nodes_ = 0;
  std::vector<std::uint32_t> references_;
};

}  // namespace

void retract_kd_tree(KdOutput& tree, const Aabb& root, const SahCost& cost) {
  Retractor(tree, cost).run(root);
  tree.counts = {};
}

}  // namespace strahl
