#include <algorithm>
#include <array>
#include <utility>

#include <strahl/build/collapse.h>
#include <strahl/build/hierarchy.h>
#include <strahl/build/linked_tree.h>

namespace strahl {
namespace {

/// Places the children of one node after all others, from the last node down.
class Placer {
 public:
  Placer(const Tree& tree, Hierarchy& out) : tree_(tree), out_(out) {
    out_.nodes.push_back({tree_.nodes[0].box});
  }

  /// Calls place(from, to) for node `from` of the tree, placed as `to`, until nothing waits.
  template <class Place>
  void run(Place place) {
    waiting_.push_back({0, 0});
    while (!waiting_.empty()) {
      const auto [from, to] = waiting_.back();
      waiting_.pop_back();
      place(from, to);
    }
  }

  void add_children(std::uint32_t to, std::span<const std::uint32_t> from) {
    const auto first = static_cast<std::uint32_t>(out_.nodes.size());
    out_.nodes[to].first = first;
    out_.nodes[to].children = static_cast<std::uint32_t>(from.size());
    for (const std::uint32_t node : from) out_.nodes.push_back({tree_.nodes[node].box});
    for (std::size_t i = from.size(); i-- > 0;)
      waiting_.push_back({from[i], first + static_cast<std::uint32_t>(i)});
  }

  void make_leaf(std::uint32_t to, std::span<const std::uint32_t> references) {
    const auto first = static_cast<std::uint32_t>(out_.references.size());
    out_.references.insert(out_.references.end(), references.begin(), references.end());
    const auto begin = out_.references.begin() + first;
    std::sort(begin, out_.references.end());
    // Parts of one primitive may meet in a leaf.
    out_.references.erase(std::unique(begin, out_.references.end()), out_.references.end());
    out_.nodes[to].first = first;
    out_.nodes[to].count = static_cast<std::uint32_t>(out_.references.size()) - first;
  }

 private:
  const Tree& tree_;
  Hierarchy& out_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> waiting_;
};

}  // namespace

int Hierarchy::depth() const {
  std::vector<int> depth(nodes.size(), 0);
  int deepest = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    deepest = std::max(deepest, depth[i]);
    for (std::uint32_t k = 0; k < nodes[i].children; ++k) depth[nodes[i].first + k] = depth[i] + 1;
  }
  return deepest;
}

double Hierarchy::sah_cost(const SahCost& cost) const {
  double sum = 0.0;
  for (const HierarchyNode& node : nodes) {
    const double share = sah_share(node.box.half_area(), nodes[0].box.half_area());
    sum += share * (node.is_leaf() ? sah_leaf_cost(cost, node.count) : cost.traverse);
  }
  return sum;
}

Hierarchy make_hierarchy(const Tree& tree) {
  Hierarchy out;
  out.nodes.reserve(tree.nodes.size());
  out.references.reserve(tree.references.size());
  Placer placer(tree, out);
  placer.run([&](std::uint32_t from, std::uint32_t to) {
    const TreeNode& node = tree.nodes[from];
    if (node.is_leaf()) {
      placer.make_leaf(to, std::span(tree.references).subspan(node.first, node.count));
      return;
    }
    const std::uint32_t pair[2] = {from + 1, node.right};
    placer.add_children(to, pair);
  });
  return out;
}

Tree make_binary(const Hierarchy& hierarchy) {
  LinkedTree linked;
  linked.nodes.resize(hierarchy.nodes.size());
  for (std::uint32_t i = 0; i < hierarchy.nodes.size(); ++i) {
    const HierarchyNode& from = hierarchy.nodes[i];
    LinkedNode& to = linked.nodes[i];
    to.box = from.box;
    if (from.is_leaf()) {
      to.right = hierarchy.references[from.first];
      continue;
    }
    to.left = from.first, to.right = from.first + 1;
    linked.nodes[to.left].parent = linked.nodes[to.right].parent = i;
  }
  return make_tree(linked);
}

Hierarchy make_hierarchy(const Tree& tree, const Collapse& collapse) {
  Hierarchy out;
  out.references.reserve(tree.references.size());
  Placer placer(tree, out);
  placer.run([&](std::uint32_t from, std::uint32_t to) {
    if (collapse.is_block(from)) {
      placer.make_leaf(to, collapse.references(from));
      return;
    }
    std::array<std::uint32_t, CollapseRules::kMaxWidth> children;
    const int count = collapse.children(from, children);
    placer.add_children(to, std::span(children).first(static_cast<std::size_t>(count)));
  });
  return out;
}

}  // namespace strahl
