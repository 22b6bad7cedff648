// structures/adaptive_grid/adaptive_grid_validate.cpp - the invariants, executable.
#include <stdexcept>
#include <string>

#include <strahl/structures/adaptive_grid/adaptive_grid.h>

namespace strahl {

class AdaptiveGridChecker {
 public:
  AdaptiveGridChecker(const AdaptiveGrid& made, const PrimitiveSource& source)
      : made_(made), source_(source), is_seen_(source.size()) {}

  void run() {
    if (!made_.tree_.nodes.empty()) {
      demand(check_node(0, 0) == made_.tree_.nodes.size(), "a node is in no tree");
      check_same_counts(made_.report_, made_.count(), AdaptiveGrid::kName);
      const double limit = made_.max_growth_ * static_cast<double>(source_.size());
      const std::uint64_t words = sub_grid_words(made_.grids_, outermost_);
      demand(static_cast<double>(words) <= limit, "sub-grids are larger than allowed");
    }
    for (std::uint32_t i = 0; i < source_.size(); ++i)
      demand(is_seen_[i] == !source_.bounds(i).is_empty(), "a primitive is nowhere");
    demand(cells_ == made_.grids_.first.size() - made_.grids_.grids.size(), "a grid is in no leaf");
    demand(small_ <= made_.has_orphan_grid_, "a cluster is too small");
    demand(!made_.has_orphan_grid_ || leaves_ == 0, "an orphan is not in the grid of orphans");
  }

 private:
  static void demand(bool holds, const char* broken) {
    if (!holds) throw std::logic_error(std::string(AdaptiveGrid::kName) + ": " + broken);
  }

  /// @return the node after the subtree
  std::size_t check_node(std::uint32_t at, int depth) {
    const std::vector<TreeNode>& nodes = made_.tree_.nodes;
    demand(at < nodes.size() && depth <= AdaptiveGrid::kMaxDepth, "a node is out of range");
    const TreeNode& node = nodes[at];
    if (node.is_leaf()) {
      check_leaf(node);
      return at + 1;
    }
    const std::size_t right = check_node(at + 1, depth + 1);
    demand(node.right == right && right < nodes.size(), "the right child is not after the left");
    const std::size_t end = check_node(node.right, depth + 1);
    demand(node.box.contains(nodes[at + 1].box) && node.box.contains(nodes[right].box),
           "a box does not enclose its children");
    return end;
  }

  void check_leaf(const TreeNode& node) {
    demand(node.count == 1 && node.first < made_.tree_.references.size(),
           "a leaf has not one thing");
    const std::uint32_t entry = made_.tree_.references[node.first];
    if (NestedGrids::is_grid(entry)) return check_grid(node, NestedGrids::grid_of(entry));
    ++leaves_;
    take(node, entry);
  }

  void check_grid(const TreeNode& node, std::uint32_t grid) {
    demand(grid < made_.grids_.grids.size(), "a grid is out of range");
    std::vector<PrimRef> refs;
    for (const std::uint32_t i : nested_contents(made_.grids_, grid)) {
      take(node, i);
      refs.push_back({source_.bounds(i), i});
    }
    small_ += refs.size() < made_.min_cluster_;
    outermost_.push_back(grid);
    check_nested_grid(made_.grids_, grid, refs, made_.is_exact_, source_, AdaptiveGrid::kName);
    cells_ += report_of(made_.grids_, grid).nodes;
  }

  void take(const TreeNode& node, std::uint32_t i) {
    demand(i < source_.size() && !is_seen_[i], "a primitive is in two places");
    is_seen_[i] = true;
    const Aabb box = source_.bounds(i);
    demand(!box.is_empty() && node.box.contains(box), "a leaf does not enclose what is in it");
  }

  const AdaptiveGrid& made_;
  const PrimitiveSource& source_;
  std::vector<bool> is_seen_;
  std::vector<std::uint32_t> outermost_;
  std::uint64_t cells_ = 0;
  int small_ = 0, leaves_ = 0;
};

void AdaptiveGrid::validate(const PrimitiveSource& source) const {
  AdaptiveGridChecker(*this, source).run();
}

}  // namespace strahl
