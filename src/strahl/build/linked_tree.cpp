#include <algorithm>
#include <cmath>
#include <utility>

#include <strahl/build/linked_tree.h>
#include <strahl/build/object_split.h>

namespace strahl {

LinkedTree LinkedTree::of_leaves(std::span<const PrimRef> refs) {
  LinkedTree tree;
  tree.nodes.reserve(2 * refs.size());
  for (const PrimRef& ref : refs)
    tree.nodes.push_back({ref.box, LinkedNode::kNone, LinkedNode::kNone, ref.reference});
  return tree;
}

std::uint32_t LinkedTree::join(std::uint32_t left, std::uint32_t right) {
  const auto inner = static_cast<std::uint32_t>(nodes.size());
  nodes.push_back({Aabb::join(nodes[left].box, nodes[right].box), LinkedNode::kNone, left, right});
  nodes[left].parent = nodes[right].parent = inner;
  return root = inner;
}

void LinkedTree::replace_child(std::uint32_t old, std::uint32_t fresh) {
  const std::uint32_t parent = nodes[old].parent;
  nodes[fresh].parent = parent;
  if (parent == LinkedNode::kNone)
    root = fresh;
  else if (nodes[parent].left == old)
    nodes[parent].left = fresh;
  else
    nodes[parent].right = fresh;
}

void LinkedTree::refit_from(std::uint32_t node) {
  for (std::uint32_t at = node; at != LinkedNode::kNone; at = nodes[at].parent) {
    const Aabb box = Aabb::join(nodes[nodes[at].left].box, nodes[nodes[at].right].box);
    if (nodes[at].box == box) return;
    nodes[at].box = box;
  }
}

double LinkedTree::inner_area() const {
  double sum = 0.0;
  for (const LinkedNode& node : nodes)
    if (!node.is_leaf()) sum += node.box.half_area();
  return sum;
}

LinkedTree make_linked(const Tree& tree) {
  LinkedTree linked;
  linked.nodes.resize(tree.nodes.size());
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& from = tree.nodes[i];
    LinkedNode& to = linked.nodes[i];
    to.box = from.box;
    if (from.is_leaf()) {
      to.right = tree.references[from.first];
      continue;
    }
    to.left = static_cast<std::uint32_t>(i) + 1, to.right = from.right;
    linked.nodes[to.left].parent = linked.nodes[to.right].parent = static_cast<std::uint32_t>(i);
  }
  return linked;
}

namespace {

/// Children in the order of their centres on the axis that tells them apart best.
struct OrderedPair {
  std::uint32_t left, right, axis = 0;

  OrderedPair(const LinkedTree& tree, const LinkedNode& node) : left(node.left), right(node.right) {
    const Vec3d apart =
        doubled_center(tree.nodes[right].box) - doubled_center(tree.nodes[left].box);
    for (std::uint32_t a = 1; a < 3; ++a)
      if (std::abs(apart[static_cast<int>(a)]) > std::abs(apart[static_cast<int>(axis)])) axis = a;
    if (apart[static_cast<int>(axis)] < 0.0) std::swap(left, right);
  }
};

}  // namespace

Tree make_tree(const LinkedTree& linked) {
  struct Waiting {
    std::uint32_t node, right_of;  ///< right_of: the inner node whose right child it is
  };
  Tree tree;
  tree.nodes.reserve(linked.nodes.size());
  std::vector<Waiting> waiting{{linked.root, LinkedNode::kNone}};
  while (!waiting.empty()) {
    const Waiting at = waiting.back();
    waiting.pop_back();
    const auto index = static_cast<std::uint32_t>(tree.nodes.size());
    if (at.right_of != LinkedNode::kNone) tree.nodes[at.right_of].right = index;
    const LinkedNode& node = linked.nodes[at.node];
    if (node.is_leaf()) {
      tree.nodes.push_back({node.box, 0, static_cast<std::uint32_t>(tree.references.size()), 1, 0});
      tree.references.push_back(node.right);
      continue;
    }
    const OrderedPair pair(linked, node);
    tree.nodes.push_back({node.box, 0, 0, 0, pair.axis});
    waiting.push_back({pair.right, index});
    waiting.push_back({pair.left, LinkedNode::kNone});
  }
  return tree;
}

}  // namespace strahl
