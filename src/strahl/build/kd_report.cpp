#include <algorithm>

#include <strahl/build/kd_policy.h>

namespace strahl {
namespace {

/// Counts leaves and sums up, over all nodes, the chance to be crossed times the work done there.
struct Survey {
  const KdArrays& tree;
  SahCost cost;
  double root_area;
  BuildReport report;

  void visit(std::uint32_t index, const Aabb& cell, std::uint64_t depth) {
    const KdNode& node = tree.nodes[index];
    const double share = sah_share(cell.half_area(), root_area);
    if (node.is_leaf()) {
      ++report.leaves;
      report.empty_leaves += node.count() == 0;
      report.references += node.count();
      report.depth = std::max(report.depth, depth);
      report.sah_cost += share * sah_leaf_cost(cost, node.count());
      return;
    }
    // A filter and the plane behind it are one step.
    if (!node.is_filter()) report.sah_cost += share * cost.traverse;
    Aabb left = cell, right = cell;
    if (!node.is_filter()) left.hi[node.axis()] = right.lo[node.axis()] = node.plane();
    visit(index + 1, left, depth + 1);
    visit(node.right(), right, depth + 1);
  }
};

}  // namespace

BuildReport report_kd_tree(const KdArrays& tree, const Aabb& root, const SahCost& cost) {
  Survey survey{tree, cost, root.half_area(), {}};
  survey.visit(0, root, 0);
  survey.report.sah_cost /= cost.traverse;
  survey.report.nodes = tree.nodes.size();
  survey.report.bytes =
      tree.nodes.capacity() * sizeof(KdNode) + tree.references.capacity() * sizeof(std::uint32_t);
  return survey.report;
}

}  // namespace strahl
