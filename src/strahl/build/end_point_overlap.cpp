#include <utility>
#include <vector>

#include <strahl/build/ancestry.h>
#include <strahl/build/end_point_overlap.h>
#include <strahl/build/overlap_sum.h>
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
        ancestry_(tree.nodes, scene.size()) {}

  OverlapAreas sum(std::uint32_t begin, std::uint32_t end) const {
    std::vector<std::uint32_t> owner(nodes_.size(), kNone);  // last primitive found below
    OverlapAreas areas;
    for (std::uint32_t i = begin; i < end; ++i) {
      if (!ancestry_.holds(i)) continue;
      ancestry_.mark(i, i, owner);
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
        sum += piece.area() * cost_.of(node);
      }
      for (std::uint32_t c = 0; c < node.children; ++c) waiting.emplace_back(node.first + c, piece);
    }
    return sum;
  }

  const std::vector<HierarchyNode>& nodes_;
  VisitCost cost_;
  const Scene& scene_;
  Ancestry ancestry_;
};

}  // namespace

double end_point_overlap(const BoxTree& tree, const Scene& scene, const BuildContext& context) {
  if (tree.nodes.nodes.empty()) return 0.0;
  const OverlapSum sums(tree, scene);
  return overlap_share(
      scene, context, [&](std::uint32_t begin, std::uint32_t end) { return sums.sum(begin, end); });
}

}  // namespace strahl
