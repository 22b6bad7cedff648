#include <algorithm>

#include <strahl/build/tree.h>

namespace strahl {

void Tree::append(const Tree& part) {
  const auto node_shift = static_cast<std::uint32_t>(nodes.size());
  const auto reference_shift = static_cast<std::uint32_t>(references.size());
  for (TreeNode node : part.nodes) {
    if (node.is_leaf())
      node.first += reference_shift;
    else
      node.right += node_shift;
    nodes.push_back(node);
  }
  references.insert(references.end(), part.references.begin(), part.references.end());
}

int Tree::depth() const {
  std::vector<int> depth(nodes.size(), 0);
  int deepest = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    deepest = std::max(deepest, depth[i]);
    if (!nodes[i].is_leaf()) depth[i + 1] = depth[nodes[i].right] = depth[i] + 1;
  }
  return deepest;
}

double Tree::sah_cost(const SahCost& cost) const {
  double sum = 0.0;
  for (const TreeNode& node : nodes) {
    const double share = sah_share(node.box.half_area(), nodes[0].box.half_area());
    sum += share * (node.is_leaf() ? sah_leaf_cost(cost, node.count) : cost.traverse);
  }
  return sum;
}

}  // namespace strahl
