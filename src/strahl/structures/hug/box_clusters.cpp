#include <algorithm>

#include <strahl/build/object_tree.h>
#include <strahl/structures/hug/box_clusters.h>

namespace strahl {
namespace {

constexpr int kBins = 8;
constexpr std::size_t kReportEvery = 1u << 14;

/// Boxes by position, grown by half of the distance on each side; those shrunk to less than nothing
/// keep their middle.
std::vector<PrimRef> grown(std::span<const PrimRef> refs, double distance) {
  std::vector<PrimRef> boxes;
  boxes.reserve(refs.size());
  for (const PrimRef& ref : refs) {
    const Vec3d by = Vec3d::all(0.5 * distance), middle = ref.box.center();
    const Aabb box{min(ref.box.lo - by, middle), max(ref.box.hi + by, middle)};
    boxes.push_back({box, static_cast<std::uint32_t>(boxes.size())});
  }
  return boxes;
}

class FloodFill {
 public:
  FloodFill(const std::vector<PrimRef>& boxes, const BuildContext& context) : boxes_(boxes) {
    Aabb all;
    for (const PrimRef& box : boxes) all.extend(box.box);
    std::vector<PrimRef> sorted = boxes;
    const SahCost cost;
    const auto splitter = make_binned_splitter(sorted, kBins, cost);
    tree_ = build_object_tree(*splitter, boxes.size(), all, {cost, 4, 64}, context);
    left_.resize(tree_.nodes.size());
    for (std::size_t i = tree_.nodes.size(); i-- > 0;) {
      const TreeNode& node = tree_.nodes[i];
      left_[i] = node.is_leaf() ? node.count : left_[i + 1] + left_[node.right];
    }
  }

  /// Takes all that hang together with the box out of the tree.
  std::vector<std::uint32_t> take_cluster(std::uint32_t seed) {
    std::vector<std::uint32_t> cluster;
    take_overlapping(0, boxes_[seed].box, cluster);
    for (std::size_t next = 0; next < cluster.size(); ++next) {
      const Aabb box = boxes_[cluster[next]].box;
      take_overlapping(0, box, cluster);
    }
    std::sort(cluster.begin(), cluster.end());
    return cluster;
  }

 private:
  void take_overlapping(std::uint32_t at, const Aabb& box, std::vector<std::uint32_t>& taken) {
    const TreeNode& node = tree_.nodes[at];
    if (left_[at] == 0 || !node.box.overlaps(box)) return;
    if (!node.is_leaf()) {
      take_overlapping(at + 1, box, taken);
      take_overlapping(node.right, box, taken);
      left_[at] = left_[at + 1] + left_[node.right];
      return;
    }
    // What is left of a leaf stands first.
    std::uint32_t* const first = tree_.references.data() + node.first;
    const auto stays = [&](std::uint32_t i) { return !boxes_[i].box.overlaps(box); };
    std::uint32_t* const end = std::stable_partition(first, first + left_[at], stays);
    taken.insert(taken.end(), end, first + left_[at]);
    left_[at] = static_cast<std::uint32_t>(end - first);
  }

  const std::vector<PrimRef>& boxes_;
  Tree tree_;
  std::vector<std::uint32_t> left_;  ///< boxes below each node that are not taken
};

}  // namespace

std::vector<std::vector<std::uint32_t>> find_clusters(std::span<const PrimRef> refs,
                                                      double distance,
                                                      const BuildContext& context) {
  if (refs.empty()) return {};
  const std::vector<PrimRef> boxes = grown(refs, distance);
  FloodFill fill(boxes, context);
  std::vector<bool> is_taken(boxes.size());
  std::vector<std::vector<std::uint32_t>> clusters;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (i % kReportEvery == 0)
      context.check(static_cast<double>(i) / static_cast<double>(boxes.size()), "clustering");
    if (is_taken[i]) continue;
    clusters.push_back(fill.take_cluster(i));
    for (const std::uint32_t taken : clusters.back()) is_taken[taken] = true;
  }
  return clusters;
}

}  // namespace strahl
