#include <utility>

#include <strahl/build/collapse.h>
#include <strahl/structures/wide_bvh/wide_bvh.h>

namespace strahl {
namespace {

/// Places nodes breadth first, so that children are consecutive and behind their parent.
class BoxTreeMaker {
 public:
  explicit BoxTreeMaker(const WideTree& tree) : tree_(tree) {}

  Hierarchy run() {
    out_.nodes.emplace_back();
    ids_.push_back(tree_.root);
    for (std::size_t at = 0; at < ids_.size(); ++at)
      is_leaf(ids_[at]) ? place_block(at) : place_children(at);
    enclose_children();
    return std::move(out_);
  }

 private:
  /// The root has no box in the tree, and the order of any hit moves low x planes of nodes of 16 by
  /// some units in the last place (wide_any_order.h), a child's further than its parent's maybe.
  void enclose_children() {
    for (std::size_t at = out_.nodes.size(); at-- > 0;)
      for (const HierarchyNode& child : out_.children(out_.nodes[at]))
        out_.nodes[at].box.extend(child.box);
  }

  void place_block(std::size_t at) {
    const std::uint32_t lanes = lanes_of(ids_[at]);
    const std::uint32_t* references = reference_row(tree_.at(ids_[at]), lanes);
    out_.nodes[at].first = static_cast<std::uint32_t>(out_.references.size());
    out_.nodes[at].count = lanes;
    out_.references.insert(out_.references.end(), references, references + lanes);
  }

  void place_children(std::size_t at) {
    const std::byte* node = tree_.at(ids_[at]);
    const auto first = static_cast<std::uint32_t>(ids_.size());
    for (int slot = 0; slot < tree_.width; ++slot) {
      const Aabb box = box_of(node, slot);
      if (box.is_empty()) continue;
      ids_.push_back(child_row(node, tree_.width)[slot]);
      out_.nodes.push_back({box, 0, 0, 0});
    }
    out_.nodes[at].first = first;
    out_.nodes[at].children = static_cast<std::uint32_t>(ids_.size()) - first;
  }

  Aabb box_of(const std::byte* node, int slot) const {
    const auto corner = [&](int row) {
      const auto plane = [&](int axis) {
        return static_cast<double>(plane_row(node, tree_.width, row + axis)[slot]);
      };
      return Vec3d{plane(0), plane(1), plane(2)} / tree_.frame.scale + tree_.frame.center;
    };
    return {corner(0), corner(3)};
  }

  const WideTree& tree_;
  Hierarchy out_;
  std::vector<WideId> ids_;  ///< of the nodes placed
};

}  // namespace

BoxTree WideBvh::box_tree() const {
  const CollapseRules rules;
  const VisitCost cost{rules.node_cost, rules.leaf_cost, rules.primitive_cost};
  return {tree_.is_empty() ? Hierarchy{} : BoxTreeMaker(tree_).run(), cost};
}

}  // namespace strahl
