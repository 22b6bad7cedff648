#include <vector>

#include <strahl/build/object_tree.h>
#include <strahl/structures/bvh/bvh_build.h>

namespace strahl {
namespace {

/// What both splitters need at their peak, per primitive, and the finished tree, twice.
constexpr std::uint64_t kSweepBytes = 3 * 4 + 1 + 8 + 4;
constexpr std::uint64_t kTreeBytes = 2 * (sizeof(TreeNode) + sizeof(HierarchyNode)) + 2 * 4;

}  // namespace

Hierarchy build_bvh_hierarchy(const PrimitiveSource& source, const BvhOptions& options,
                              const BuildContext& context) {
  std::vector<PrimRef> refs = make_prim_refs(source, context);
  if (refs.empty()) return {};
  const bool sweeps = options.builder == BvhBuilder::sah_sweep;
  context.require_memory(refs.size() * (sizeof(PrimRef) + kTreeBytes + (sweeps ? kSweepBytes : 0)),
                         "bvh");
  Aabb box;
  for (const PrimRef& ref : refs) box.extend(ref.box);
  const SahCost cost{options.traverse_cost, options.intersect_cost};
  const auto splitter =
      sweeps ? make_sweep_splitter(refs, cost) : make_binned_splitter(refs, options.bins, cost);
  const LeafRules rules{cost, static_cast<std::size_t>(options.leaf_size), kBvhMaxDepth};
  return make_hierarchy(build_object_tree(*splitter, refs.size(), box, rules, context));
}

}  // namespace strahl
