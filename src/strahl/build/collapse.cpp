#include <algorithm>
#include <stdexcept>

#include <strahl/base/large_pages.h>
#include <strahl/build/collapse.h>

namespace strahl {
namespace {

constexpr std::uint32_t kForkNodes = 8192;  // smaller subtrees stay on one thread

}  // namespace

Collapse::Collapse(const Tree& tree, const CollapseRules& rules, const BuildContext& context)
    : tree_(tree),
      rules_(rules),
      executor_(context.executor),
      whole_(tree.nodes[0].box.half_area()),
      runs_(tree.nodes.size()),
      is_block_(tree.nodes.size(), 0) {
  if (rules.width < 2 || rules.width > CollapseRules::kMaxWidth)
    throw std::logic_error("collapse: width");
  const std::size_t choices = tree.nodes.size() * static_cast<std::size_t>(rules.width);
  choices_.reserve(choices);
  prefer_large_pages(choices_.data(), choices);
  choices_.resize(choices);
  context.check(0.0, "collapsing");
  cost_ = solve(0, static_cast<std::uint32_t>(tree.nodes.size()))[1];
  context.check(1.0, "collapsing");
}

Collapse::Costs Collapse::solve_leaf(std::uint32_t node) {
  const TreeNode& leaf = tree_.nodes[node];
  if (leaf.count > rules_.max_leaf) throw std::logic_error("collapse: a leaf exceeds a block");
  runs_[node] = {leaf.first, leaf.count};
  is_block_[node] = 1;
  Costs costs;
  costs[1] = sah_share(leaf.box.half_area(), whole_) *
             (rules_.leaf_cost + rules_.primitive_cost * leaf.count);
  return costs;
}

/// Nodes node..end are the subtree.
Collapse::Costs Collapse::solve(std::uint32_t node, std::uint32_t end) {
  const TreeNode& at = tree_.nodes[node];
  if (at.is_leaf()) return solve_leaf(node);
  Costs left, right;
  const auto solve_left = [&] { left = solve(node + 1, at.right); };
  const auto solve_right = [&] { right = solve(at.right, end); };
  if (end - node > kForkNodes) {
    executor_.invoke(solve_left, solve_right);
  } else {
    solve_left(), solve_right();
  }
  runs_[node] = {runs_[node + 1].first, runs_[node + 1].count + runs_[at.right].count};
  Costs costs;
  join(node, left, right, costs);
  costs[1] = cheapest_child(node, costs[costs.most]);
  for (int j = 2; j <= costs.most; ++j) {
    if (costs[j] < costs[j - 1]) continue;
    costs[j] = costs[j - 1];
    // The node's own children, all `width` of them, are not given up for one child less.
    choice(node, j) |= kFewer;
  }
  return costs;
}

/// Costs of two children and more, and how many of them the left subtree gives.
void Collapse::join(std::uint32_t node, const Costs& left, const Costs& right, Costs& costs) {
  costs.most = std::min(left.most + right.most, rules_.width);
  for (int j = 2; j <= costs.most; ++j) {
    double best = Aabb::kInf;
    for (int k = std::max(1, j - right.most); k <= std::min(left.most, j - 1); ++k) {
      const double cost = left[k] + right[j - k];
      if (!(cost < best)) continue;
      best = cost;
      choice(node, j) = static_cast<std::uint8_t>(k);
    }
    costs[j] = best;
  }
  for (int j = costs.most + 1; j <= rules_.width; ++j)
    choice(node, j) = choice(node, costs.most) | kFewer;
}

/// As one child: a block or a wide node.
double Collapse::cheapest_child(std::uint32_t node, double as_children) {
  const double share = sah_share(tree_.nodes[node].box.half_area(), whole_);
  const std::uint32_t count = runs_[node].count;
  const double as_node = share * rules_.node_cost + as_children;
  const double as_block = count <= rules_.max_leaf
                              ? share * (rules_.leaf_cost + rules_.primitive_cost * count)
                              : Aabb::kInf;
  is_block_[node] = as_block <= as_node;
  return std::min(as_block, as_node);
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
