#include <memory>
#include <vector>

#include <strahl/build/agglomerative.h>
#include <strahl/build/linked_tree.h>
#include <strahl/build/object_tree.h>
#include <strahl/build/optimise.h>
#include <strahl/build/ploc.h>
#include <strahl/build/spatial_tree.h>
#include <strahl/geometry/scene.h>
#include <strahl/structures/bvh/bvh_build.h>
#include <strahl/structures/bvh/bvh_leaves.h>

namespace strahl {
namespace {

/// The finished tree, twice, per primitive; and what builders need at their peak beside it.
constexpr std::uint64_t kTreeBytes = 2 * (sizeof(TreeNode) + sizeof(HierarchyNode) + 4);
constexpr std::uint64_t kSweepBytes = 4 + 4 + 4 + 1 + 8 + 4;
constexpr std::uint64_t kCurveBytes = 16 + 16;
constexpr std::uint64_t kLinkedBytes = 2 * sizeof(LinkedNode);

class BvhBuild {
 public:
  BvhBuild(const PrimitiveSource& source, const BvhOptions& options, const BuildContext& context)
      : source_(source),
        options_(options),
        context_(context),
        cost_{options.traverse_cost, options.intersect_cost},
        refs_(make_prim_refs(source, context)) {
    for (const PrimRef& ref : refs_) box_.extend(ref.box);
  }

  Hierarchy run() {
    if (refs_.empty()) return {};
    require_memory();
    if (options_.builder == BvhBuilder::goldsmith_salmon && !is_optimised()) return insert();
    Tree tree = bottom_up_or_divided();
    if (!ends_in_single_primitives() && options_.arity == 2) return make_hierarchy(tree);
    if (is_optimised()) optimise(tree);
    if (ends_in_single_primitives()) return finish_bvh_tree(std::move(tree), options_, context_);
    return make_hierarchy(tree, Collapse(tree, collapse_rules(options_), context_));
  }

 private:
  bool is_optimised() const { return options_.optimise != BvhOptimise::none; }
  /// Leaves are made of such trees at the end.
  bool ends_in_single_primitives() const {
    return is_optimised() || options_.builder == BvhBuilder::agglomerative ||
           options_.builder == BvhBuilder::ploc || options_.builder == BvhBuilder::spatial;
  }

  void require_memory() const {
    const double growth = options_.builder == BvhBuilder::spatial ? 1.0 + options_.duplicates : 1.0;
    const double references = growth * static_cast<double>(refs_.size());
    context_.require_memory(static_cast<std::uint64_t>(references) * bytes_per_primitive(), "bvh");
  }

  std::uint64_t bytes_per_primitive() const {
    std::uint64_t bytes = sizeof(PrimRef) + kTreeBytes;
    if (options_.builder == BvhBuilder::sah_sweep) bytes += kSweepBytes;
    if (options_.builder == BvhBuilder::lbvh) bytes += kCurveBytes;
    if (options_.builder == BvhBuilder::scene_graph) bytes += sizeof(ScenePart);
    if (options_.builder == BvhBuilder::agglomerative) bytes += agglomerative_bytes(1);
    if (options_.builder == BvhBuilder::ploc) bytes += kCurveBytes + 16;
    if (ends_in_single_primitives() || options_.arity > 2)
      bytes += kLinkedBytes + Collapse::bytes(2, options_.arity) + kSweepBytes;
    if (options_.optimise == BvhOptimise::reinsertion) bytes += reinsertion_bytes(1);
    return bytes;
  }

  Tree bottom_up_or_divided() {
    switch (options_.builder) {
      case BvhBuilder::agglomerative:
        return make_tree(build_agglomerative_tree(refs_, context_));
      case BvhBuilder::ploc:
        return make_tree(build_ploc_tree(refs_, options_.radius, context_));
      case BvhBuilder::goldsmith_salmon:
        return make_binary(insert());
      case BvhBuilder::spatial:
        return cut();
      default:
        return divide();
    }
  }

  Tree cut() {
    SpatialRules rules;
    rules.cost = cost_, rules.growth = options_.duplicates, rules.max_depth = kBvhMaxDepth;
    rules.object_bins = rules.spatial_bins = options_.bins;
    return build_spatial_tree(source_, std::move(refs_), box_, rules, context_);
  }

  Tree divide() {
    const std::size_t leaf =
        ends_in_single_primitives() ? 1 : static_cast<std::size_t>(options_.leaf_size);
    const std::vector<ScenePart> parts = parts_of_references();
    const auto splitter = make_splitter(parts);
    return build_object_tree(*splitter, refs_.size(), box_, {cost_, leaf, kBvhMaxDepth}, context_);
  }

  std::unique_ptr<ObjectSplitter> make_splitter(std::span<const ScenePart> parts) {
    switch (options_.builder) {
      case BvhBuilder::scene_graph:
        return make_scene_graph_splitter(refs_, parts, cost_);
      case BvhBuilder::median_cyclic:
        return make_median_splitter(refs_, MedianAxis::cyclic, cost_);
      case BvhBuilder::median_longest:
        return make_median_splitter(refs_, MedianAxis::longest, cost_);
      case BvhBuilder::sah_sweep:
        return make_sweep_splitter(refs_, cost_);
      case BvhBuilder::lbvh:
        return make_morton_splitter(refs_, cost_, context_);
      default:
        return make_binned_splitter(refs_, options_.bins, cost_);
    }
  }

  /// What is not a scene, such as the contents of an instance, is one group.
  std::vector<ScenePart> parts_of_references() const {
    if (options_.builder != BvhBuilder::scene_graph) return {};
    std::vector<ScenePart> parts(refs_.size());
    const auto* scene = dynamic_cast<const Scene*>(&source_);
    if (scene == nullptr) return parts;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Part& part = scene->part_of(refs_[i].reference);
      parts[i] = {part.instance, part.geometry};
    }
    return parts;
  }

  Hierarchy insert() const {
    InsertionRules rules;
    rules.search = options_.insert_search, rules.order = options_.insert_order;
    rules.seed = options_.seed, rules.attach_share = options_.attach_share;
    rules.cost = cost_, rules.max_depth = kBvhMaxDepth;
    // The optimisers work on binary trees of single primitives.
    rules.max_children = is_optimised() ? 2U : static_cast<std::uint32_t>(options_.arity);
    rules.max_leaf = is_optimised() ? 1 : static_cast<std::size_t>(options_.leaf_size);
    return build_insertion_tree(refs_, rules, context_);
  }

  void optimise(Tree& tree) const {
    LinkedTree linked = make_linked(tree);
    if (options_.optimise == BvhOptimise::rotations)
      rotate_tree(linked, context_);
    else
      reinsert_nodes(linked, {}, context_);
    tree = make_tree(linked);
  }

  const PrimitiveSource& source_;
  const BvhOptions& options_;
  const BuildContext& context_;
  SahCost cost_;
  std::vector<PrimRef> refs_;
  Aabb box_;
};

}  // namespace

Hierarchy build_bvh_hierarchy(const PrimitiveSource& source, const BvhOptions& options,
                              const BuildContext& context) {
  return BvhBuild(source, options, context).run();
}

}  // namespace strahl
