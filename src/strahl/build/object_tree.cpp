#include <algorithm>
#include <bit>
#include <optional>

#include <strahl/build/object_tree.h>
#include <strahl/build/top_down.h>

namespace strahl {
namespace {

class ObjectPolicy {
 public:
  using Work = ObjectSet;
  using Output = Tree;

  ObjectPolicy(ObjectSplitter& splitter, const LeafRules& rules)
      : splitter_(splitter), rules_(rules) {}

  std::optional<ObjectSplit> plan(const ObjectSet& set, int depth) const {
    if (set.size() <= rules_.undivided) return std::nullopt;
    // Halving from here on ends in single primitives within the levels that are left.
    const int levels_left = rules_.max_depth - depth;
    if (static_cast<int>(std::bit_width(set.size() - 1)) >= levels_left)
      return splitter_.find_median(set);
    const ObjectSplit best = splitter_.find(set);
    const bool fits = set.size() <= rules_.max_leaf;
    if (fits && sah_leaf_cost(rules_.cost, set.size()) <= best.cost) return std::nullopt;
    return best.is_found() ? best : splitter_.find_median(set);
  }

  void leaf(const ObjectSet& set, Tree& out) const {
    const std::size_t first = out.references.size();
    out.nodes.push_back(
        {set.box, 0, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(set.size()), 0});
    splitter_.list(set, out.references);
    std::sort(out.references.begin() + static_cast<std::ptrdiff_t>(first), out.references.end());
  }

  std::size_t open(const ObjectSet& set, const ObjectSplit& split, Tree& out) const {
    out.nodes.push_back({set.box, 0, 0, 0, static_cast<std::uint32_t>(split.axis)});
    return out.nodes.size() - 1;
  }

  std::pair<ObjectSet, ObjectSet> divide(const ObjectSet& set, const ObjectSplit& split) const {
    return splitter_.divide(set, split);
  }

  void link(Tree& out, std::size_t inner) const {
    out.nodes[inner].right = static_cast<std::uint32_t>(out.nodes.size());
  }
  void append(Tree& out, const Tree& part) const { out.append(part); }
  std::size_t weight(const ObjectSet& set) const { return set.size(); }
  Tree make_output() const { return {}; }

 private:
  ObjectSplitter& splitter_;
  const LeafRules& rules_;
};

}  // namespace

Tree build_object_tree(ObjectSplitter& splitter, std::size_t primitives, const Aabb& box,
                       const LeafRules& rules, const BuildContext& context) {
  Tree tree;
  ObjectPolicy policy(splitter, rules);
  TopDown<ObjectPolicy>(policy, context, primitives).run({0, primitives, box, box}, tree);
  return tree;
}

}  // namespace strahl
