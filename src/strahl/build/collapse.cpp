#include <algorithm>
#include <stdexcept>

#include <strahl/build/collapse.h>

namespace strahl {

Collapse::Collapse(const Tree& tree, const CollapseRules& rules, const BuildContext& context)
    : tree_(tree),
      rules_(rules),
      whole_(tree.nodes[0].box.half_area()),
      runs_(tree.nodes.size()),
      is_block_(tree.nodes.size(), 0),
      choices_(tree.nodes.size() * static_cast<std::size_t>(rules.width), 0) {
  if (rules.width < 2 || rules.width > CollapseRules::kMaxWidth)
    throw std::logic_error("collapse: width");
  context.check(0.0, "collapsing");
  cost_ = solve(0)[1];
  context.check(1.0, "collapsing");
}

Collapse::Costs Collapse::solve_leaf(std::uint32_t node) {
  const TreeNode& leaf = tree_.nodes[node];
  if (leaf.count > rules_.max_leaf) throw std::logic_error("collapse: a leaf exceeds a block");
  runs_[node] = {leaf.first, leaf.count};
  is_block_[node] = 1;
  Costs costs;
  costs.fill(sah_share(leaf.box.half_area(), whole_) *
             (rules_.leaf_cost + rules_.primitive_cost * leaf.count));
  return costs;
}

Collapse::Costs Collapse::solve(std::uint32_t node) {
  const TreeNode& at = tree_.nodes[node];
  if (at.is_leaf()) return solve_leaf(node);
  const Costs left = solve(node + 1), right = solve(at.right);
  runs_[node] = {runs_[node + 1].first, runs_[node + 1].count + runs_[at.right].count};
  Costs costs;
  for (int j = 2; j <= rules_.width; ++j) {
    double best = Aabb::kInf;
    for (int k = 1; k < j; ++k) {
      const double cost =
          left[static_cast<std::size_t>(k)] + right[static_cast<std::size_t>(j - k)];
      if (!(cost < best)) continue;
      best = cost;
      choice(node, j) = static_cast<std::uint8_t>(k);
    }
    costs[static_cast<std::size_t>(j)] = best;
  }
  const double share = sah_share(at.box.half_area(), whole_);
  const std::uint32_t count = runs_[node].count;
  const double as_node = share * rules_.node_cost + costs[static_cast<std::size_t>(rules_.width)];
  const double as_block = count <= rules_.max_leaf
                              ? share * (rules_.leaf_cost + rules_.primitive_cost * count)
                              : Aabb::kInf;
  is_block_[node] = as_block <= as_node;
  costs[1] = std::min(as_block, as_node);
  for (std::size_t j = 2; j <= static_cast<std::size_t>(rules_.width); ++j) {
    if (costs[j] < costs[j - 1]) continue;
    costs[j] = costs[j - 1];
    // The node's own children, all `width` of them, are not given up for one child less.
    choice(node, static_cast<int>(j)) |= kFewer;
  }
  return costs;
}

void Collapse::give(std::uint32_t node, int most, std::uint32_t*& out) const {
  const auto width = static_cast<std::size_t>(rules_.width);
  const std::uint8_t* choices = &choices_[node * width];
  while (most > 1 && (tree_.nodes[node].is_leaf() || (choices[most - 1] & kFewer) != 0)) --most;
  if (most == 1) {
    *out++ = node;
    return;
  }
  const int left = choices[most - 1];
  give(node + 1, left, out);
  give(tree_.nodes[node].right, most - left, out);
}

int Collapse::children(std::uint32_t node,
                       std::span<std::uint32_t, CollapseRules::kMaxWidth> out) const {
  const auto width = static_cast<std::size_t>(rules_.width);
  const int left = choices_[node * width + width - 1] & ~kFewer;
  std::uint32_t* end = out.data();
  give(node + 1, left, end);
  give(tree_.nodes[node].right, rules_.width - left, end);
  return static_cast<int>(end - out.data());
}

}  // namespace strahl
