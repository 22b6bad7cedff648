#include <algorithm>
#include <stdexcept>
#include <string>

#include <strahl/structures/bih/bih.h>
#include <strahl/structures/bih/bih_validate.h>

namespace strahl {
namespace {

void demand(bool holds, const char* broken) {
  if (!holds) throw std::logic_error(std::string("bih: ") + broken);
}

/// Walks the tree with the box that the stored planes leave of the root's.
class BihChecker {
 public:
  BihChecker(const BihArrays& tree, const PrimitiveSource& source)
      : tree_(tree), source_(source), seen_(source.size(), 0) {}

  void run(const Aabb& root, const BuildReport& report) {
    if (!tree_.nodes.empty()) visit({0, 0, 0}, root);
    for (std::uint32_t i = 0; i < source_.size(); ++i)
      demand(seen_[i] == (source_.bounds(i).is_empty() ? 0 : 1),
             "a primitive is not in exactly one leaf");
    demand(visited_ == tree_.nodes.size(), "nodes that have no parent or several");
    demand(references_ == tree_.references.size(), "references outside of leaves");
    demand(report.nodes == visited_ && report.leaves == leaves_, "report: nodes");
    demand(report.references == references_ && report.depth == deepest_, "report: references");
  }

 private:
  /// A node, its depth, and how many nodes above it have two children.
  struct Place {
    std::size_t node;
    std::uint64_t depth;
    int forks;
  };

  void visit(const Place& at, const Aabb& cell) {
    ++visited_;
    const BihNode& node = tree_.nodes[at.node];
    demand(at.forks <= Bih::kMaxDepth, "a node is too deep for the traversal");
    if (node.is_leaf()) return visit_leaf(node, at, cell);
    demand(node.child() > at.node, "a child does not follow its parent");
    demand(node.child() + !node.is_trimmed() < tree_.nodes.size(), "a child beyond the last node");
    if (node.is_trimmed()) {
      const int axis = node.trimmed_axis();
      demand(axis < 3, "an axis is out of range");
      const AxisSide low{axis, true, node.plane(0)}, high{axis, false, node.plane(1)};
      return visit({node.child(), at.depth + 1, at.forks}, high.cut(low.cut(cell)));
    }
    for (std::size_t i = 0; i < 2; ++i) {
      demand(node.side(i).axis < 3, "an axis is out of range");
      visit({node.child() + i, at.depth + 1, at.forks + 1}, node.side(i).cut(cell));
    }
  }

  void visit_leaf(const BihNode& leaf, const Place& at, const Aabb& cell) {
    ++leaves_;
    deepest_ = std::max(deepest_, at.depth);
    references_ += leaf.count();
    demand(leaf.count() > 0, "an empty leaf");
    const std::size_t last = std::size_t{leaf.first()} + leaf.count();
    demand(last <= tree_.references.size(), "a leaf's references are out of range");
    for (std::size_t i = leaf.first(); i < last; ++i) {
      const std::uint32_t reference = tree_.references[i];
      demand(reference < source_.size(), "a reference is out of range");
      demand(i == leaf.first() || tree_.references[i - 1] < reference,
             "references of a leaf do not ascend");
      demand(cell.contains(source_.bounds(reference)), "a plane cuts a primitive below it");
      ++seen_[reference];
    }
  }

  const BihArrays& tree_;
  const PrimitiveSource& source_;
  std::vector<int> seen_;
  std::size_t visited_ = 0;
  std::uint64_t leaves_ = 0, references_ = 0, deepest_ = 0;
};

}  // namespace

void validate_bih(const BihArrays& tree, const Aabb& root, const BuildReport& report,
                  const PrimitiveSource& source) {
  BihChecker(tree, source).run(root, report);
}

}  // namespace strahl
