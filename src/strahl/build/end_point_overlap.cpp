#include <atomic>
#include <utility>
#include <vector>

#include <strahl/build/end_point_overlap.h>
#include <strahl/geometry/surface_piece.h>

namespace strahl {
namespace {

constexpr std::uint32_t kNone = ~0u;

class OverlapSum {
 public:
  OverlapSum(const BoxTree& tree, const Scene& scene)
      : nodes_(tree.nodes.nodes),
        cost_(tree.cost),
        scene_(scene),
        parent_(nodes_.size(), kNone),
        first_leaf_(scene.size(), kNone),
        next_leaf_(tree.nodes.references.size(), kNone),
        leaf_(tree.nodes.references.size(), kNone) {
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
      const HierarchyNode& node = nodes_[i];
      for (std::uint32_t c = 0; c < node.children; ++c) parent_[node.first + c] = i;
      for (std::uint32_t at = node.first; at < node.first + node.count; ++at) {
        std::uint32_t& first = first_leaf_[tree.nodes.references[at]];
        leaf_[at] = i, next_leaf_[at] = first, first = at;
      }
    }
  }

  struct Areas {
    double surface = 0.0, overlap = 0.0;  ///< of the primitives; weighted by what visits cost
  };

  Areas sum(std::uint32_t begin, std::uint32_t end) const {
    std::vector<std::uint32_t> owner(nodes_.size(), kNone);  // last primitive found below
    Areas areas;
    for (std::uint32_t i = begin; i < end; ++i) {
      if (first_leaf_[i] == kNone) continue;
      for (std::uint32_t at = first_leaf_[i]; at != kNone; at = next_leaf_[at])
        for (std::uint32_t up = leaf_[at]; up != kNone && owner[up] != i; up = parent_[up])
          owner[up] = i;
      visit_surface(scene_, i, [&](const auto& surface) {
        areas.surface += surface.area();
        areas.overlap += overlap_of(i, surface, owner);
      });
    }
    return areas;
  }

 private:
  /// Nodes on the way to the primitive enclose it, or the boxes below them, so that only foreign
  /// nodes cut.
  template <class Piece>
  double overlap_of(std::uint32_t i, const Piece& surface,
                    const std::vector<std::uint32_t>& owner) const {
    double sum = 0.0;
    std::vector<std::pair<std::uint32_t, Piece>> waiting{{0, surface}};
    while (!waiting.empty()) {
      auto [at, piece] = std::move(waiting.back());
      waiting.pop_back();
      const HierarchyNode& node = nodes_[at];
      if (owner[at] != i) {
        piece.cut_to(node.box);
        if (piece.is_empty()) continue;
        sum += piece.area() * cost_of(node);
      }
      for (std::uint32_t c = 0; c < node.children; ++c) waiting.emplace_back(node.first + c, piece);
    }
    return sum;
  }

  double cost_of(const HierarchyNode& node) const {
    return node.is_leaf() ? cost_.leaf + cost_.reference * node.count : cost_.inner;
  }

  const std::vector<HierarchyNode>& nodes_;
  VisitCost cost_;
  const Scene& scene_;
  std::vector<std::uint32_t> parent_;
  /// Places of a primitive among the references, as a list, and the leaf of each.
  std::vector<std::uint32_t> first_leaf_, next_leaf_, leaf_;
};

}  // namespace

double end_point_overlap(const BoxTree& tree, const Scene& scene, const BuildContext& context) {
  if (tree.nodes.nodes.empty()) return 0.0;
  constexpr std::size_t kChunks = 64;
  const std::size_t grain = scene.size() / kChunks + 1;
  const OverlapSum sums(tree, scene);
  std::vector<OverlapSum::Areas> parts(kChunks);
  std::atomic<std::size_t> done{0};
  context.executor.parallel_for(0, scene.size(), grain, [&](std::size_t from, std::size_t to) {
    parts[from / grain] =
        sums.sum(static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(to));
    context.check(static_cast<double>(++done) / kChunks, "end-point overlap");
  });
  OverlapSum::Areas all;
  for (const OverlapSum::Areas& part : parts)
    all.surface += part.surface, all.overlap += part.overlap;
  return all.surface > 0.0 ? all.overlap / all.surface : 0.0;
}

}  // namespace strahl
