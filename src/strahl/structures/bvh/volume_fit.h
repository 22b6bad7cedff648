// structures/bvh/volume_fit.h - the volumes of a hierarchy's nodes.
//
// Method:     the nodes below a size are wrapped around the primitives themselves, those above it
//             around the boxes of nodes below them: conservative, a little loose where nodes are
//             large, and the work per primitive does not grow with the tree. Boxes are taken over,
//             k-DOPs of inner nodes merged, as both are exact.
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <atomic>
#include <span>
#include <vector>

#include <strahl/base/build_context.h>
#include <strahl/bounds/aabb_volume.h>
#include <strahl/bounds/kdop_volume.h>
#include <strahl/build/hierarchy.h>
#include <strahl/geometry/primitive_source.h>

namespace strahl {

/// Says what the volumes of nodes have to enclose. Source and hierarchy must outlive it.
class NodeContents {
 public:
  /// Primitives, or boxes in their place, that one volume is wrapped around at most.
  static constexpr std::size_t kMost = 2048;

  NodeContents(const PrimitiveSource& source, const Hierarchy& hierarchy);

  EnclosedSet of(std::uint32_t node) const;
  const Hierarchy& hierarchy() const { return hierarchy_; }

 private:
  void add_primitives(std::uint32_t node, EnclosedSet& set) const;
  void add_boxes(std::uint32_t node, EnclosedSet& set) const;

  const PrimitiveSource& source_;
  const Hierarchy& hierarchy_;
  std::vector<std::uint32_t> below_;  ///< references per subtree
};

/// Calls body(node) for all nodes, in any order; tells the progress.
template <class Body>
void for_each_node(const Hierarchy& hierarchy, const BuildContext& context, Body body) {
  constexpr std::size_t kGrain = 64;
  const auto total = static_cast<double>(hierarchy.nodes.size());
  std::atomic<std::size_t> done = 0;
  context.executor.parallel_for(0, hierarchy.nodes.size(), kGrain,
                                [&](std::size_t first, std::size_t last) {
                                  for (std::size_t i = first; i < last; ++i)
                                    body(static_cast<std::uint32_t>(i));
                                  const std::size_t now = done += last - first;
                                  context.check(static_cast<double>(now) / total, "fitting");
                                });
}

/// A volume of type V around what `contents` says of a node; boxes are those of the hierarchy.
template <BoundingVolume V>
V fit_volume(const NodeContents& contents, std::uint32_t node) {
  if constexpr (V::kKind == BoundingVolumeKind::aabb)
    return V(contents.hierarchy().nodes[node].box);
  else
    return V::enclose(contents.of(node), FitEffort::fast);
}

/// Volumes of type V, one per node.
template <BoundingVolume V>
std::vector<V> fit_volumes(const NodeContents& contents, const BuildContext& context) {
  constexpr bool kMerges =
      V::kKind == BoundingVolumeKind::kdop6 || V::kKind == BoundingVolumeKind::kdop14 ||
      V::kKind == BoundingVolumeKind::kdop18 || V::kKind == BoundingVolumeKind::kdop26;
  const std::vector<HierarchyNode>& nodes = contents.hierarchy().nodes;
  std::vector<V> volumes(nodes.size());
  for_each_node(contents.hierarchy(), context, [&](std::uint32_t i) {
    if (!kMerges || nodes[i].is_leaf()) volumes[i] = fit_volume<V>(contents, i);
  });
  for (std::size_t i = nodes.size(); kMerges && i-- > 0;)
    for (std::uint32_t k = 0; k < nodes[i].children; ++k)
      volumes[i] = V::merge(volumes[i], volumes[nodes[i].first + k]);
  return volumes;
}

}  // namespace strahl
