#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <strahl/build/ancestry.h>
#include <strahl/build/cut_piece.h>
#include <strahl/build/end_point_overlap.h>
#include <strahl/build/overlap_sum.h>

namespace strahl {
namespace {

constexpr std::uint32_t kNone = ~0u;

/// What is found out once about a tree and those below it. Trees that are shared have one entry.
class Forest {
 public:
  explicit Forest(const SideTree& root) { add(root); }

  std::size_t size() const { return ancestry_.size(); }
  std::size_t nodes_of(std::size_t tree) const { return nodes_[tree]; }
  std::size_t number_of(const SideTree& tree) const { return numbers_.at(&tree); }
  const Ancestry& ancestry(std::size_t tree) const { return ancestry_[tree]; }

 private:
  void add(const SideTree& tree) {
    if (!numbers_.try_emplace(&tree, numbers_.size()).second) return;
    std::size_t things = tree.things.size();
    for (const std::uint32_t r : tree.nodes.references)
      things = std::max(things, std::size_t{r} + 1);
    ancestry_.emplace_back(tree.nodes, things);
    nodes_.push_back(tree.nodes.nodes.size());
    for (const SideTree::Thing& thing : tree.things) add(*thing.tree);
  }

  std::map<const SideTree*, std::size_t> numbers_;
  std::vector<Ancestry> ancestry_;
  std::vector<std::size_t> nodes_;
};

/// Of one primitive after the other; one object per thread.
class NestedSum {
 public:
  NestedSum(const SideTree& root, const Forest& forest) : root_(root), forest_(forest) {
    for (std::size_t t = 0; t < forest.size(); ++t) owner_.emplace_back(forest.nodes_of(t), kNone);
  }

  OverlapAreas areas_of(const Scene& scene, std::uint32_t primitive) {
    OverlapAreas areas;
    primitive_ = primitive;
    way_.clear();
    if (!mark(root_, primitive)) return areas;
    visit_shape(scene, primitive, [&](const auto& shape) {
      CutPiece surface(shape);
      areas.surface = surface.area();
      areas.overlap = overlap_in(root_, std::move(surface), {0, true, nullptr});
    });
    return areas;
  }

 private:
  /// How a tree was reached.
  struct Level {
    std::size_t depth;  ///< trees above
    bool is_own;        ///< whether the primitive is in it
    const Placement* placement;
  };

  /// Marks all nodes above the primitive and remembers the things on the way to it. False if it is
  /// in no leaf.
  bool mark(const SideTree& tree, std::uint32_t number) {
    const std::size_t t = forest_.number_of(tree);
    std::uint32_t reference = number;
    const SideTree::Thing* below = nullptr;
    if (!tree.things.empty()) {
      const auto after = std::upper_bound(
          tree.things.begin(), tree.things.end(), number,
          [](std::uint32_t n, const SideTree::Thing& thing) { return n < thing.first; });
      if (after == tree.things.begin()) return false;
      below = &*(after - 1);
      if (number - below->first >= below->size) return false;
      reference = static_cast<std::uint32_t>(below - tree.things.data());
    }
    if (!forest_.ancestry(t).holds(reference)) return false;
    forest_.ancestry(t).mark(reference, primitive_, owner_[t]);
    way_.push_back(reference);
    return below == nullptr || mark(*below->tree, number - below->first);
  }

  /// Only foreign nodes cut: those on the way to the primitive enclose it.
  double overlap_in(const SideTree& tree, CutPiece surface, const Level& level) {
    if (tree.nodes.nodes.empty()) return 0.0;
    const std::vector<std::uint32_t>& owner = owner_[forest_.number_of(tree)];
    double sum = 0.0;
    std::vector<std::pair<std::uint32_t, CutPiece>> waiting;
    waiting.emplace_back(0, std::move(surface));
    while (!waiting.empty()) {
      auto [at, piece] = std::move(waiting.back());
      waiting.pop_back();
      const HierarchyNode& node = tree.nodes.nodes[at];
      const bool is_own = level.is_own && owner[at] == primitive_;
      if (!is_own) {
        piece.cut_to({tree.sides_of(at), tree.extents[at], level.placement});
        if (piece.is_empty()) continue;
        sum += piece.area() * tree.cost.of(node);
      }
      for (std::uint32_t c = 0; c < node.children; ++c) waiting.emplace_back(node.first + c, piece);
      if (!tree.things.empty()) sum += overlap_below(tree, node, piece, level, is_own);
    }
    return sum;
  }

  /// In the trees of what a leaf refers to.
  double overlap_below(const SideTree& tree, const HierarchyNode& leaf, const CutPiece& piece,
                       const Level& level, bool is_own) {
    double sum = 0.0;
    for (std::uint32_t at = leaf.first; at < leaf.first + leaf.count; ++at) {
      const std::uint32_t reference = tree.nodes.references[at];
      const SideTree::Thing& thing = tree.things[reference];
      const Placement* placement = thing.placement ? &*thing.placement : level.placement;
      const bool is_way = is_own && way_[level.depth] == reference;
      sum += overlap_in(*thing.tree, piece, {level.depth + 1, is_way, placement});
    }
    return sum;
  }

  const SideTree& root_;
  const Forest& forest_;
  std::vector<std::vector<std::uint32_t>> owner_;  ///< per tree and node: last primitive below it
  std::vector<std::uint32_t> way_;                 ///< per level, what leads to the primitive
  std::uint32_t primitive_ = kNone;
};

}  // namespace

double end_point_overlap(const SideTree& tree, const Scene& scene, const BuildContext& context) {
  if (tree.nodes.nodes.empty()) return 0.0;
  const Forest forest(tree);
  return overlap_share(scene, context, [&](std::uint32_t begin, std::uint32_t end) {
    NestedSum sum(tree, forest);
    OverlapAreas areas;
    for (std::uint32_t i = begin; i < end; ++i) {
      const OverlapAreas own = sum.areas_of(scene, i);
      areas.surface += own.surface, areas.overlap += own.overlap;
    }
    return areas;
  });
}

}  // namespace strahl
