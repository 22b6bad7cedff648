#include <utility>
#include <vector>

#include <strahl/build/reinsert_top.h>

namespace strahl {
namespace {

constexpr std::uint32_t kNone = LinkedNode::kNone;
constexpr std::uint32_t kSeen = 8;  // times what is moved as a whole: enough to tell the overlap

/// A subtree: nodes [node, end), and its parent's place elsewhere.
struct Waiting {
  std::uint32_t node, end, parent;
  std::uint32_t size() const { return end - node; }
};

/// Calls visit(subtree) for subtrees from the root down, which returns what its children get as
/// their parent; none where they are not to be visited.
template <class Visit>
void descend(const Tree& tree, Visit visit) {
  std::vector<Waiting> waiting{{0, static_cast<std::uint32_t>(tree.nodes.size()), kNone}};
  while (!waiting.empty()) {
    const Waiting at = waiting.back();
    waiting.pop_back();
    const std::uint32_t place = visit(at);
    if (place == kNone) continue;
    const std::uint32_t right = tree.nodes[at.node].right;
    waiting.push_back({right, at.end, place});
    waiting.push_back({at.node + 1, right, place});
  }
}

/// Overlap of the children of nodes over the nodes' areas, for those with more nodes below them.
double overlap_above(const Tree& tree, std::uint32_t nodes) {
  double common = 0.0, all = 0.0;
  descend(tree, [&](const Waiting& at) {
    const TreeNode& node = tree.nodes[at.node];
    if (node.is_leaf() || at.size() <= nodes) return kNone;
    const Aabb &left = tree.nodes[at.node + 1].box, &right = tree.nodes[node.right].box;
    common += Aabb::intersection(left, right).half_area();
    all += node.box.half_area();
    return 0u;
  });
  return all > 0.0 ? common / all : 0.0;
}

/// The upper nodes of a tree; the references of its leaves are nodes of the tree, the roots of the
/// subtrees that stay as they are.
class TopOfTree {
 public:
  TopOfTree(const Tree& tree, std::uint32_t whole) : tree_(tree) {
    descend(tree, [&](const Waiting& at) {
      const std::uint32_t place = add(at.node, at.parent);
      return tree.nodes[at.node].is_leaf() || at.size() <= whole ? kNone : place;
    });
  }

  LinkedTree& linked() { return linked_; }

  /// The whole tree with its upper nodes as they are now.
  Tree assemble() const {
    const Tree order = make_tree(linked_);
    Tree out;
    out.nodes.reserve(tree_.nodes.size()), out.references.reserve(tree_.references.size());
    std::vector<std::uint32_t> place(order.nodes.size());
    for (std::size_t i = 0; i < order.nodes.size(); ++i) {
      place[i] = static_cast<std::uint32_t>(out.nodes.size());
      if (order.nodes[i].is_leaf())
        copy(order.references[order.nodes[i].first], out);
      else
        out.nodes.push_back(order.nodes[i]);
    }
    for (std::size_t i = 0; i < order.nodes.size(); ++i)
      if (!order.nodes[i].is_leaf()) out.nodes[place[i]].right = place[order.nodes[i].right];
    return out;
  }

 private:
  std::uint32_t add(std::uint32_t node, std::uint32_t parent) {
    const auto place = static_cast<std::uint32_t>(linked_.nodes.size());
    linked_.nodes.push_back({tree_.nodes[node].box, parent, kNone, node});
    if (parent == kNone) return place;
    LinkedNode& above = linked_.nodes[parent];
    (above.left == kNone ? above.left : above.right) = place;
    return place;
  }

  void copy(std::uint32_t from, Tree& out) const {
    const auto to = static_cast<std::uint32_t>(out.nodes.size());
    std::uint32_t last = from;
    while (!tree_.nodes[last].is_leaf()) last = tree_.nodes[last].right;
    for (std::uint32_t i = from; i <= last; ++i) {
      TreeNode node = tree_.nodes[i];
      if (node.is_leaf()) {
        const std::uint32_t* const first = tree_.references.data() + node.first;
        node.first = static_cast<std::uint32_t>(out.references.size());
        out.references.insert(out.references.end(), first, first + node.count);
      } else {
        node.right = node.right - from + to;
      }
      out.nodes.push_back(node);
    }
  }

  const Tree& tree_;
  LinkedTree linked_;
};

}  // namespace

Tree reinsert_top(Tree tree, const TopRules& rules, const BuildContext& context) {
  // A copy, the upper nodes at worst, and what a round needs for them.
  context.require_memory(tree.nodes.size() * (sizeof(TreeNode) + sizeof(LinkedNode)) +
                             reinsertion_bytes(tree.nodes.size() / 2 + 1),
                         "reinsertion");
  if (!(overlap_above(tree, kSeen * rules.whole) >= rules.least_overlap)) return tree;
  TopOfTree top(tree, rules.whole);
  reinsert_nodes(top.linked(), rules.reinsertion, context);
  Tree moved = top.assemble();
  return moved.depth() <= rules.max_depth ? moved : tree;
}

}  // namespace strahl
