// structures/bvh/bvh_validate.cpp - the invariants of a bounding volume hierarchy, executable.
#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>

#include <strahl/structures/bvh/bvh.h>

namespace strahl {
namespace {

void demand(bool holds, const char* broken) {
  if (!holds) throw std::logic_error(std::string("bvh: ") + broken);
}

}  // namespace

/// Reads the nodes in order: parents come first, so depths and claims are known when needed.
class BvhChecker {
 public:
  BvhChecker(const Bvh& bvh, const PrimitiveSource& source)
      : bvh_(bvh), source_(source), seen_(source.size(), 0), depth_(bvh.nodes_.size(), kUnclaimed) {
    if (!depth_.empty()) depth_[0] = 0;
  }

  void run() {
    for (std::size_t i = 0; i < depth_.size(); ++i) {
      demand(depth_[i] != kUnclaimed, "a node has no parent before it");
      if (bvh_.nodes_[i].count == 0)
        check_children(i);
      else
        check_leaf(bvh_.nodes_[i], depth_[i]);
    }
    for (std::uint32_t i = 0; i < source_.size(); ++i)
      demand(seen_[i] == (source_.bounds(i).is_empty() ? 0u : 1u),
             "a primitive is not in exactly one leaf");
    check_report(bvh_.report_);
  }

 private:
  static constexpr int kUnclaimed = -1;

  void check_children(std::size_t node) {
    const Bvh::Node& parent = bvh_.nodes_[node];
    demand(parent.first > node && parent.first + std::size_t{1} < depth_.size(),
           "children are misplaced");
    for (std::size_t child = parent.first; child < parent.first + std::size_t{2}; ++child) {
      demand(depth_[child] == kUnclaimed, "a node has two parents");
      depth_[child] = depth_[node] + 1;
      demand(parent.box().contains(bvh_.nodes_[child].box()), "a box does not enclose a child's");
    }
  }

  void check_leaf(const Bvh::Node& leaf, int depth) {
    demand(depth <= Bvh::kMaxDepth, "a leaf is too deep");
    demand(std::uint64_t{leaf.first} + leaf.count <= bvh_.references_.size(),
           "a leaf's references are out of range");
    const std::span own = std::span(bvh_.references_).subspan(leaf.first, leaf.count);
    demand(std::adjacent_find(own.begin(), own.end(), std::greater_equal<>()) == own.end(),
           "references of a leaf do not ascend");
    demand(own.back() < source_.size(), "a reference is out of range");
    for (const std::uint32_t reference : own) {
      demand(leaf.box().contains(source_.bounds(reference)), "a box does not enclose a primitive");
      ++seen_[reference];
    }
    ++leaves_, total_ += leaf.count, deepest_ = std::max(deepest_, depth);
  }

  void check_report(const BuildReport& report) const {
    demand(total_ == bvh_.references_.size(), "references are in no leaf");
    demand(report.nodes == depth_.size() && report.leaves == leaves_, "report: nodes");
    demand(report.references == total_, "report: references");
    demand(report.depth == static_cast<std::uint64_t>(deepest_), "report: depth");
    demand(report.sah_cost == (depth_.empty() ? 0.0 : bvh_.sah_cost()), "report: SAH cost");
  }

  const Bvh& bvh_;
  const PrimitiveSource& source_;
  std::vector<std::uint32_t> seen_;  ///< leaves per primitive
  std::vector<int> depth_;
  std::uint64_t leaves_ = 0, total_ = 0;
  int deepest_ = 0;
};

void Bvh::validate(const PrimitiveSource& source) const { BvhChecker(*this, source).run(); }

}  // namespace strahl
