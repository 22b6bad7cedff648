#include <optional>
#include <stdexcept>
#include <utility>

#include <strahl/bounds/all_volumes.h>
#include <strahl/structures/bvh/any_volume.h>
#include <strahl/structures/bvh/bvh.h>
#include <strahl/structures/bvh/bvh_refit.h>
#include <strahl/structures/bvh/child_order.h>
#include <strahl/structures/bvh/volume_choice.h>

namespace strahl {

extern template class BvhTree<AabbVolume>;
extern template class BvhTree<SphereVolume>;
extern template class BvhTree<ObbVolume>;
extern template class BvhTree<KdopVolume<6>>;
extern template class BvhTree<KdopVolume<14>>;
extern template class BvhTree<KdopVolume<18>>;
extern template class BvhTree<KdopVolume<26>>;
extern template class BvhTree<CylinderVolume>;
extern template class BvhTree<HullVolume>;
extern template class BvhTree<PrismVolume>;
extern template class BvhTree<ShellVolume>;
extern template class BvhTree<IntersectionVolume>;
extern template class BvhTree<AnyVolume>;

namespace {

/// What a hull or a prism may own besides itself.
constexpr std::uint64_t kOwned = 12 * sizeof(FacePlane);

/// Children are put in order after the volumes were fitted, so that these are the same for all
/// traversals.
template <class V>
std::unique_ptr<VolumeTree> join_tree(Hierarchy hierarchy, std::vector<V> volumes,
                                      BvhTraversal traversal, const SahCost& cost) {
  const Aabb world = hierarchy.nodes[0].box;
  ChildOrder order;
  if (traversal == BvhTraversal::direction) {
    order = order_children(hierarchy);
    volumes = order.applied_to(std::move(volumes));
  }
  return std::make_unique<BvhTree<V>>(std::move(hierarchy), std::move(volumes), world, cost,
                                      order.axes);
}

template <class V>
std::unique_ptr<VolumeTree> make_tree(const PrimitiveSource& source, Hierarchy hierarchy,
                                      BvhTraversal traversal, const SahCost& cost,
                                      const BuildContext& context) {
  const std::uint64_t per_node = sizeof(BvhNode<V>) + sizeof(V) + sizeof(HierarchyNode) +
                                 (std::is_trivially_copyable_v<V> ? 0 : kOwned);
  context.require_memory(hierarchy.nodes.size() * per_node, "bvh");
  std::vector<V> volumes = fit_volumes<V>(NodeContents(source, hierarchy), context);
  return join_tree(std::move(hierarchy), std::move(volumes), traversal, cost);
}

/// Each node with the kind that the cost model prefers.
std::unique_ptr<VolumeTree> make_auto_tree(const PrimitiveSource& source, Hierarchy hierarchy,
                                           BvhTraversal traversal, const SahCost& cost,
                                           const BuildContext& context) {
  constexpr std::uint64_t kPerNode = sizeof(BvhNode<AnyVolume>) + sizeof(AnyVolume) +
                                     sizeof(HierarchyNode) + kOwned + 2 * sizeof(VolumeAreas);
  context.require_memory(hierarchy.nodes.size() * kPerNode, "bvh");
  const NodeContents contents(source, hierarchy);
  VolumeCosts costs;
  costs.primitive *= cost.intersect / cost.traverse;
  const std::vector<BoundingVolumeKind> kinds =
      choose_volumes(hierarchy, measure_volumes(contents, context), costs).kinds;
  std::vector<AnyVolume> volumes(kinds.size());
  for_each_node(hierarchy, context, [&](std::uint32_t i) {
    volumes[i] = with_volume_type(kinds[i],
                                  [&]<class V>() { return AnyVolume(fit_volume<V>(contents, i)); });
  });
  return join_tree(std::move(hierarchy), std::move(volumes), traversal, cost);
}

}  // namespace

Bvh::Bvh(const PrimitiveSource& source, const Options& options, const BuildContext& context)
    : options_(options), traversal_(options.traversal) {
  Hierarchy hierarchy = build_bvh_hierarchy(source, options, context);
  if (hierarchy.nodes.empty()) return;
  if (options.builder == BvhBuilder::spatial)
    refers_once_ = count_things(hierarchy, source.size()) == hierarchy.references.size();
  take(source, std::move(hierarchy), context);
  built_cost_ = tree_->report().sah_cost;
}

void Bvh::take(const PrimitiveSource& source, Hierarchy hierarchy, const BuildContext& context) {
  const SahCost cost{options_.traverse_cost, options_.intersect_cost};
  if (options_.bv == BvhVolume::automatic)
    tree_ = make_auto_tree(source, std::move(hierarchy), traversal_, cost, context);
  else
    tree_ = with_volume_type(static_cast<BoundingVolumeKind>(options_.bv), [&]<class V>() {
      return make_tree<V>(source, std::move(hierarchy), traversal_, cost, context);
    });
  const auto* boxes = dynamic_cast<const BvhTree<AabbVolume>*>(tree_.get());
  const bool is_fast =
      boxes != nullptr && boxes->is_binary() && traversal_ == BvhTraversal::ordered;
  binary_boxes_ = is_fast ? boxes : nullptr;
}

void Bvh::refit(const PrimitiveSource& source, const BuildContext& context) {
  std::optional<Hierarchy> fitted;
  if (tree_) fitted = fit_hierarchy(tree_->hierarchy(), source, options_, context);
  if (fitted) {
    Bvh next(options_);
    next.refers_once_ = refers_once_, next.built_cost_ = built_cost_, next.refits_ = refits_ + 1;
    next.take(source, *std::move(fitted), context);
    if (next.tree_->report().sah_cost <= options_.rebuild_factor * built_cost_) {
      *this = std::move(next);
      return;
    }
  }
  *this = Bvh(source, options_, context);
}

std::optional<BoxTree> Bvh::box_tree() const {
  std::optional<Hierarchy> nodes = tree_ ? tree_->box_hierarchy() : Hierarchy{};
  if (!nodes) return std::nullopt;
  return BoxTree{*std::move(nodes), visit_cost()};
}

std::shared_ptr<const SideTree> Bvh::side_tree() const {
  SideTree tree;
  if (tree_) tree = tree_->side_tree();
  tree.cost = visit_cost();
  return std::make_shared<const SideTree>(std::move(tree));
}

VisitCost Bvh::visit_cost() const {
  return {1.0, 0.0, options_.intersect_cost / options_.traverse_cost};
}

void Bvh::validate(const PrimitiveSource& source) const {
  if (tree_) return tree_->validate(source, refers_once_);
  for (std::uint32_t i = 0; i < source.size(); ++i)
    if (!source.bounds(i).is_empty())
      throw std::logic_error("bvh: a primitive is not in exactly one leaf");
}

}  // namespace strahl
