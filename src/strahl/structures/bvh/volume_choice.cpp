#include <strahl/bounds/all_volumes.h>
#include <strahl/structures/bvh/volume_choice.h>

namespace strahl {
namespace {

/// Two passes over the nodes: costs upward, choices downward.
class Chooser {
 public:
  Chooser(const Hierarchy& hierarchy, std::span<const VolumeAreas> areas, const VolumeCosts& costs)
      : nodes_(hierarchy.nodes), areas_(areas), costs_(costs), below_(nodes_.size()) {}

  VolumeChoice run() {
    for (std::size_t i = nodes_.size(); i-- > 0;)
      for (std::size_t kind = 0; kind < kVolumeKinds; ++kind) below_[i][kind] = cost_below(i, kind);
    VolumeChoice choice;
    choice.kinds.resize(nodes_.size());
    const double whole = areas_[0][static_cast<std::size_t>(BoundingVolumeKind::aabb)];
    const auto [kind, cost] = cheapest(0, whole);
    choice.cost = whole > 0.0 ? cost / whole : 0.0;
    choice.kinds[0] = static_cast<BoundingVolumeKind>(kind);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const double area = areas_[i][static_cast<std::size_t>(choice.kinds[i])];
      for (std::uint32_t k = 0; k < nodes_[i].children; ++k)
        choice.kinds[nodes_[i].first + k] =
            static_cast<BoundingVolumeKind>(cheapest(nodes_[i].first + k, area).kind);
    }
    return choice;
  }

 private:
  struct Best {
    std::size_t kind = 0;  ///< a box where nothing is cheaper
    double cost = Aabb::kInf;
  };

  /// Of a node that is tested by rays as `area` tells. Ties go to the first kind.
  Best cheapest(std::size_t node, double area) const {
    Best best;
    for (std::size_t kind = 0; kind < kVolumeKinds; ++kind) {
      const double cost = area * costs_.test[kind] + below_[node][kind];
      if (cost < best.cost) best = {kind, cost};
    }
    return best;
  }

  double cost_below(std::size_t i, std::size_t kind) const {
    const double area = areas_[i][kind];
    if (!(area < Aabb::kInf)) return Aabb::kInf;
    if (nodes_[i].is_leaf()) return area * nodes_[i].count * costs_.primitive;
    double sum = 0.0;
    for (std::uint32_t k = 0; k < nodes_[i].children; ++k)
      sum += cheapest(nodes_[i].first + k, area).cost;
    return sum;
  }

  const std::vector<HierarchyNode>& nodes_;
  std::span<const VolumeAreas> areas_;
  const VolumeCosts& costs_;
  std::vector<VolumeAreas> below_;
};

}  // namespace

VolumeChoice choose_volumes(const Hierarchy& hierarchy, std::span<const VolumeAreas> areas,
                            const VolumeCosts& costs) {
  return Chooser(hierarchy, areas, costs).run();
}

std::vector<VolumeAreas> measure_volumes(const NodeContents& contents,
                                         const BuildContext& context) {
  std::vector<VolumeAreas> areas(contents.hierarchy().nodes.size());
  for_each_node(contents.hierarchy(), context, [&](std::uint32_t i) {
    const EnclosedSet set = contents.of(i);
    for (const BoundingVolumeInfo& info : kBoundingVolumes) {
      double& area = areas[i][static_cast<std::size_t>(info.kind)];
      if (info.kind == BoundingVolumeKind::aabb)
        area = AabbVolume(contents.hierarchy().nodes[i].box).half_area();
      else if (info.kind == BoundingVolumeKind::kdop6)
        area = Aabb::kInf;  // is a box
      else
        area = with_volume_type(
            info.kind, [&]<class V>() { return V::enclose(set, FitEffort::fast).half_area(); });
    }
  });
  return areas;
}

}  // namespace strahl
