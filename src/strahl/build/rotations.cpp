#include <utility>
#include <vector>

#include <strahl/build/optimise.h>

namespace strahl {
namespace {

constexpr int kMostPasses = 16;
constexpr double kLeastGain = 1e-3;  // of a pass, relative

class Rotations {
 public:
  explicit Rotations(LinkedTree& tree) : tree_(tree), nodes_(tree.nodes) {}

  /// @returns what the pass lowered the sum by
  double pass() {
    std::vector<std::uint32_t> order{tree_.root};  // parents first
    for (std::size_t i = 0; i < order.size(); ++i) {
      const LinkedNode& node = nodes_[order[i]];
      if (!node.is_leaf()) order.insert(order.end(), {node.left, node.right});
    }
    double gain = 0.0;
    for (std::size_t i = order.size(); i-- > 0;)
      if (!nodes_[order[i]].is_leaf()) gain += rotate(order[i]);
    return gain;
  }

 private:
  struct Exchange {
    double gain = 0.0;
    std::uint32_t a = 0, b = 0;
  };

  double area_of(std::uint32_t a, std::uint32_t b) const {
    return Aabb::join(nodes_[a].box, nodes_[b].box).half_area();
  }
  double area(std::uint32_t node) const { return nodes_[node].box.half_area(); }

  double rotate(std::uint32_t node) {
    const std::uint32_t left = nodes_[node].left, right = nodes_[node].right;
    Exchange best;
    const auto offer = [&](double gain, std::uint32_t a, std::uint32_t b) {
      if (gain > best.gain) best = {gain, a, b};
    };
    for (const auto& [child, other] : {std::pair(left, right), std::pair(right, left)}) {
      if (nodes_[other].is_leaf()) continue;
      const std::uint32_t l = nodes_[other].left, r = nodes_[other].right;
      offer(area(other) - area_of(child, r), child, l);
      offer(area(other) - area_of(child, l), child, r);
    }
    if (!nodes_[left].is_leaf() && !nodes_[right].is_leaf()) {
      const std::uint32_t ll = nodes_[left].left, lr = nodes_[left].right;
      const std::uint32_t rl = nodes_[right].left, rr = nodes_[right].right;
      const double now = area(left) + area(right);
      offer(now - area_of(rl, lr) - area_of(ll, rr), ll, rl);
      offer(now - area_of(rr, lr) - area_of(rl, ll), ll, rr);
    }
    if (best.gain > 0.0) exchange(best.a, best.b);
    return best.gain;
  }

  void exchange(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t above_a = nodes_[a].parent, above_b = nodes_[b].parent;
    (nodes_[above_a].left == a ? nodes_[above_a].left : nodes_[above_a].right) = b;
    (nodes_[above_b].left == b ? nodes_[above_b].left : nodes_[above_b].right) = a;
    nodes_[a].parent = above_b, nodes_[b].parent = above_a;
    tree_.refit_from(above_b);
    tree_.refit_from(above_a);
  }

  LinkedTree& tree_;
  std::vector<LinkedNode>& nodes_;
};

}  // namespace

void rotate_tree(LinkedTree& tree, const BuildContext& context) {
  Rotations rotations(tree);
  for (int pass = 0; pass < kMostPasses; ++pass) {
    context.check(static_cast<double>(pass) / kMostPasses, "rotating");
    if (rotations.pass() <= kLeastGain * tree.inner_area()) return;
  }
}

}  // namespace strahl
