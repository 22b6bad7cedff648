// structures/bvh/bvh_check.h - the invariants of a bounding volume hierarchy, executable.
#pragma once

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <strahl/structures/bvh/bvh_tree.h>

namespace strahl {

/// Points of a thing's surface whose hull nearly is the thing's: corners, points of rims and of
/// spheres. bounds(i) not empty.
std::vector<Vec3d> defining_points(const PrimitiveSource& source, std::uint32_t i);

/// Reads the nodes in order: parents come first, so depths and parents are known when needed.
template <class V>
class BvhChecker {
 public:
  using Node = BvhNode<V>;

  BvhChecker(const BvhTree<V>& tree, const PrimitiveSource& source)
      : tree_(tree),
        source_(source),
        seen_(source.size(), 0),
        depth_(tree.nodes_.size(), kUnclaimed),
        parent_(tree.nodes_.size(), 0) {
    if (!depth_.empty()) depth_[0] = 0;
  }

  void run() {
    for (std::size_t i = 0; i < depth_.size(); ++i) {
      demand(depth_[i] != kUnclaimed, "a node has no parent before it");
      if (tree_.nodes_[i].is_leaf())
        check_leaf(i);
      else
        check_children(i);
    }
    for (std::uint32_t i = 0; i < source_.size(); ++i)
      demand(seen_[i] == (source_.bounds(i).is_empty() ? 0u : 1u),
             "a primitive is not in exactly one leaf");
    check_report(tree_.report_);
  }

 private:
  static constexpr int kUnclaimed = -1;

  static void demand(bool holds, const char* broken) {
    if (!holds) throw std::logic_error(std::string("bvh: ") + broken);
  }

  void check_children(std::size_t node) {
    const Node& parent = tree_.nodes_[node];
    demand(parent.size() >= 2 && parent.size() <= std::uint32_t{kBvhMaxArity},
           "a node has too few or too many children");
    demand(parent.first > node && std::uint64_t{parent.first} + parent.size() <= depth_.size(),
           "children are misplaced");
    for (std::size_t child = parent.first; child < parent.first + parent.size(); ++child) {
      demand(depth_[child] == kUnclaimed, "a node has two parents");
      depth_[child] = depth_[node] + 1;
      parent_[child] = node;
    }
  }

  void check_leaf(std::size_t node) {
    const Node& leaf = tree_.nodes_[node];
    demand(depth_[node] <= kBvhMaxDepth, "a leaf is too deep");
    demand(leaf.size() > 0, "a leaf is empty");
    demand(std::uint64_t{leaf.first} + leaf.size() <= tree_.references_.size(),
           "a leaf's references are out of range");
    const std::span own = tree_.references(leaf);
    demand(std::adjacent_find(own.begin(), own.end(), std::greater_equal<>()) == own.end(),
           "references of a leaf do not ascend");
    demand(own.back() < source_.size(), "a reference is out of range");
    for (const std::uint32_t reference : own) {
      check_volumes(node, reference);
      ++seen_[reference];
    }
    ++leaves_, total_ += leaf.size(), deepest_ = std::max(deepest_, depth_[node]);
  }

  /// That all volumes from a leaf up to the root enclose what the leaf refers to.
  void check_volumes(std::size_t node, std::uint32_t reference) const {
    demand(!source_.bounds(reference).is_empty(), "a leaf refers to what is never hit");
    const std::vector<Vec3d> points = defining_points(source_, reference);
    for (bool is_root = false; !is_root; node = parent_[node]) {
      const V& volume = tree_.nodes_[node].volume;
      for (const Vec3d& p : points)
        demand(volume.contains(p), "a volume does not enclose a primitive");
      is_root = node == 0;
    }
  }

  void check_report(const BuildReport& report) const {
    demand(total_ == tree_.references_.size(), "references are in no leaf");
    demand(report.nodes == depth_.size() && report.leaves == leaves_, "report: nodes");
    demand(report.references == total_, "report: references");
    demand(report.depth == static_cast<std::uint64_t>(deepest_), "report: depth");
    demand(report.sah_cost == tree_.sah_cost(), "report: SAH cost");
  }

  const BvhTree<V>& tree_;
  const PrimitiveSource& source_;
  std::vector<std::uint32_t> seen_;  ///< leaves per primitive
  std::vector<int> depth_;
  std::vector<std::size_t> parent_;
  std::uint64_t leaves_ = 0, total_ = 0;
  int deepest_ = 0;
};

}  // namespace strahl
