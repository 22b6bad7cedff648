// build/collapse.h - a binary tree turned into one of wide nodes, the cheapest there is.
//
// Source: [YlitieKarrasLaine2017] (dynamic programming over the surface area heuristic), leaves
//   counted as blocks: a block of several primitives is tested at once, so it costs little more
//   than one of a single primitive.
// Method: cost(x, j) is that of the subtree x given as at most j children of a wide node. One child
//   is a block or a wide node; j children are what the left and right subtree give with k and j -
//   k.
// Differs from the paper: plain cost of a block instead of a cost per primitive; a subtree is not
//   asked for more children than it has leaves.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/build/tree.h>

namespace strahl {

/// What a wide node and a block of primitives cost.
struct CollapseRules {
  static constexpr int kMaxWidth = 16;
  int width = 8;                 ///< children of a node at most, 2..kMaxWidth
  std::size_t max_leaf = 8;      ///< primitives of a block at most, at least those of a tree's leaf
  double node_cost = 1.0;        ///< of a step to a wide node
  double leaf_cost = 0.8;        ///< of a block
  double primitive_cost = 0.03;  ///< and of each primitive in it
};

/// The chosen wide nodes and blocks of a tree. The tree must outlive it.
class Collapse {
 public:
  /// O(nodes * width^2), less where subtrees have fewer leaves. The same for any executor. Throws
  /// Error{cancelled}.
  Collapse(const Tree& tree, const CollapseRules& rules, const BuildContext& context);

  /// Whether the subtree is a block where it is one child of its own.
  bool is_block(std::uint32_t node) const { return is_block_[node] != 0; }
  /// References of a subtree: a run of the tree's.
  std::span<const std::uint32_t> references(std::uint32_t node) const {
    return std::span(tree_.references).subspan(runs_[node].first, runs_[node].count);
  }
  /// Subtrees that are the children of a wide node, in the order of the tree.
  /// @returns their number, 2..width
  int children(std::uint32_t node, std::span<std::uint32_t, CollapseRules::kMaxWidth> out) const;
  /// Expected cost of a random line that meets the root's box, in node steps.
  double cost() const { return cost_; }

  /// Bytes it owns for a tree of that many nodes.
  static std::uint64_t bytes(std::uint64_t nodes, int width) {
    return nodes * (sizeof(Run) + 1 + static_cast<std::uint64_t>(width));
  }

 private:
  /// Of a subtree given as 1..most children; it has no more leaves, or the width allows no more.
  struct Costs {
    int most = 1;
    std::array<double, CollapseRules::kMaxWidth + 1> at;
    double& operator[](int children) { return at[static_cast<std::size_t>(children)]; }
    double operator[](int children) const { return at[static_cast<std::size_t>(children)]; }
  };
  struct Run {
    std::uint32_t first, count;
  };

  Costs solve(std::uint32_t node, std::uint32_t end);
  Costs solve_leaf(std::uint32_t node);
  void join(std::uint32_t node, const Costs& left, const Costs& right, Costs& costs);
  double cheapest_child(std::uint32_t node, double as_children);
  void give(std::uint32_t node, int most, std::uint32_t*& out) const;
  std::uint8_t& choice(std::uint32_t node, int children) {
    return choices_[std::size_t{node} * static_cast<std::size_t>(rules_.width) +
                    static_cast<std::size_t>(children) - 1];
  }

  static constexpr std::uint8_t kFewer = 0x80;  ///< flag of a choice: one child less is cheaper

  const Tree& tree_;
  CollapseRules rules_;
  const Executor& executor_;
  double whole_;
  double cost_ = 0.0;
  std::vector<Run> runs_;
  std::vector<std::uint8_t> is_block_;
  std::vector<std::uint8_t> choices_;  ///< per node and number of children: those of the left
};

}  // namespace strahl
