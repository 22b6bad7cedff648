#include <algorithm>
#include <bit>
#include <vector>

#include <strahl/build/linked_tree.h>
#include <strahl/build/object_tree.h>

namespace strahl {
namespace {

constexpr int kSpareLevels = 8;

/// Copies a tree node by node, but for the subtrees it divides anew.
class DepthLimiter {
 public:
  DepthLimiter(const Tree& tree, const SahCost& cost, const BuildContext& context)
      : tree_(tree), cost_(cost), context_(context), shapes_(tree.nodes.size()) {
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
      const TreeNode& node = tree.nodes[i];
      if (node.is_leaf()) continue;
      const Shape &left = shapes_[i + 1], &right = shapes_[node.right];
      shapes_[i] = {std::max(left.height, right.height) + 1, left.leaves + right.leaves};
    }
  }

  Tree run(int max_depth) {
    std::vector<int> levels(tree_.nodes.size(), max_depth);  // that are left
    std::vector<std::uint32_t> place(tree_.nodes.size(), 0);
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < tree_.nodes.size();) {
      place[i] = static_cast<std::uint32_t>(out_.nodes.size());
      if (shapes_[i].height > levels[i] && levels[i] <= needed(i)) {
        divide_anew(i, levels[i]);
        i += 2 * shapes_[i].leaves - 1;
        continue;
      }
      kept.push_back(i);
      copy(i);
      const TreeNode& node = tree_.nodes[i];
      if (!node.is_leaf()) levels[i + 1] = levels[node.right] = levels[i] - 1;
      ++i;
    }
    for (const std::uint32_t i : kept)
      if (!tree_.nodes[i].is_leaf()) out_.nodes[place[i]].right = place[tree_.nodes[i].right];
    return std::move(out_);
  }

 private:
  struct Shape {
    int height = 0;
    std::uint32_t leaves = 1;
  };

  int needed(std::uint32_t node) const {
    return static_cast<int>(std::bit_width(shapes_[node].leaves - 1)) + kSpareLevels;
  }

  void copy(std::uint32_t i) {
    TreeNode node = tree_.nodes[i];
    if (node.is_leaf()) node.first = take_references(node);
    out_.nodes.push_back(node);
  }

  /// @returns where they begin
  std::uint32_t take_references(const TreeNode& leaf) {
    const auto first = static_cast<std::uint32_t>(out_.references.size());
    const auto from = tree_.references.begin() + leaf.first;
    out_.references.insert(out_.references.end(), from, from + leaf.count);
    return first;
  }

  /// The leaves of the subtree are what is divided.
  void divide_anew(std::uint32_t root, int levels) {
    std::vector<PrimRef> leaves;
    for (std::uint32_t i = root; i < root + 2 * shapes_[root].leaves - 1; ++i)
      if (tree_.nodes[i].is_leaf()) leaves.push_back({tree_.nodes[i].box, i});
    BuildContext quiet;  // progress is that of the whole build
    quiet.executor = context_.executor;
    const auto splitter = make_sweep_splitter(leaves, cost_);
    const Tree part = build_object_tree(*splitter, leaves.size(), tree_.nodes[root].box,
                                        {cost_, 1, levels}, quiet);
    const auto shift = static_cast<std::uint32_t>(out_.nodes.size());
    for (TreeNode node : part.nodes) {
      if (node.is_leaf()) {
        node = tree_.nodes[part.references[node.first]];
        node.first = take_references(node);
      } else {
        node.right += shift;
      }
      out_.nodes.push_back(node);
    }
  }

  const Tree& tree_;
  SahCost cost_;
  const BuildContext& context_;
  std::vector<Shape> shapes_;
  Tree out_;
};

}  // namespace

Tree limit_depth(Tree tree, int max_depth, const SahCost& cost, const BuildContext& context) {
  if (tree.depth() <= max_depth) return tree;
  context.check(0.0, "limiting depth");
  return DepthLimiter(tree, cost, context).run(max_depth);
}

}  // namespace strahl
