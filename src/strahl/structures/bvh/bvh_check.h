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
/// The same and, of a triangle or box, many inside: for what is in several leaves.
std::vector<Vec3d> covering_points(const PrimitiveSource& source, std::uint32_t i);

/// Reads the nodes in order: parents come first, so depths and parents are known when needed.
template <class V>
class BvhChecker {
 public:
  using Node = BvhNode<V>;

  /// @param refers_once whether no primitive may be in two leaves
  BvhChecker(const BvhTree<V>& tree, const PrimitiveSource& source, bool refers_once)
      : tree_(tree),
        source_(source),
        refers_once_(refers_once),
        leaves_of_(source.size()),
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
    for (std::uint32_t i = 0; i < source_.size(); ++i) check_primitive(i);
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
      demand(!source_.bounds(reference).is_empty(), "a leaf refers to what is never hit");
      leaves_of_[reference].push_back(node);
    }
    ++leaves_, total_ += leaf.size(), deepest_ = std::max(deepest_, depth_[node]);
  }

  /// That every point of a primitive is in a leaf that refers to it, and in all volumes above.
  void check_primitive(std::uint32_t i) const {
    const std::vector<std::size_t>& leaves = leaves_of_[i];
    if (refers_once_)
      demand(leaves.size() == (source_.bounds(i).is_empty() ? 0u : 1u),
             "a primitive is not in exactly one leaf");
    if (source_.bounds(i).is_empty()) return;
    demand(!leaves.empty(), "a primitive is in no leaf");
    const std::vector<Vec3d> points =
        leaves.size() == 1 ? defining_points(source_, i) : covering_points(source_, i);
    for (const Vec3d& p : points)
      demand(std::any_of(leaves.begin(), leaves.end(),
                         [&](std::size_t leaf) { return is_enclosed(p, leaf); }),
             "a volume does not enclose a primitive");
  }

  bool is_enclosed(const Vec3d& p, std::size_t leaf) const {
    for (std::size_t node = leaf;; node = parent_[node]) {
      if (!tree_.nodes_[node].volume.contains(p)) return false;
      if (node == 0) return true;
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
  bool refers_once_;
  std::vector<std::vector<std::size_t>> leaves_of_;  ///< per primitive
  std::vector<int> depth_;
  std::vector<std::size_t> parent_;
  std::uint64_t leaves_ = 0, total_ = 0;
  int deepest_ = 0;
};

}  // namespace strahl
