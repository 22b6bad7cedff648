#include <memory>

#include <strahl/build/object_tree.h>
#include <strahl/structures/bih/bih.h>
#include <strahl/structures/bih/bih_layout.h>
#include <strahl/structures/bih/bih_validate.h>

namespace strahl {
namespace {

/// What the sweep needs at its peak, per primitive, and the neutral tree.
constexpr std::uint64_t kSweepBytes = 3 * 4 + 1 + 8 + 4, kTreeBytes = 2 * sizeof(TreeNode) + 4;

std::unique_ptr<ObjectSplitter> make_splitter(std::span<PrimRef> refs, const BihOptions& options) {
  const SahCost cost{options.traverse_cost, options.intersect_cost};
  switch (options.split) {
    case BihSplit::sah_sweep:
      return make_sweep_splitter(refs, cost);
    case BihSplit::global:
      return make_middle_splitter(refs, cost);
    default:
      return make_binned_splitter(refs, options.bins, cost);
  }
}

Tree divide(std::vector<PrimRef> refs, const Aabb& box, const BihOptions& options,
            const BuildContext& context) {
  const LeafRules rules{{options.traverse_cost, options.intersect_cost},
                        static_cast<std::size_t>(options.leaf_size),
                        Bih::kMaxDepth};
  const auto splitter = make_splitter(refs, options);
  return build_object_tree(*splitter, refs.size(), box, rules, context);
}

/// What a node leaves of its box to child c.
Aabb child_box(const BihNode& node, std::uint32_t c, const Aabb& box) {
  if (!node.is_trimmed()) return node.side(c).cut(box);
  const int axis = node.trimmed_axis();
  return AxisSide{axis, false, node.plane(1)}.cut(AxisSide{axis, true, node.plane(0)}.cut(box));
}

}  // namespace

OptionTable<BihOptions> option_fields(const BihOptions*) {
  using O = BihOptions;
  return {
      option(
          "split", &O::split,
          {{"sah", BihSplit::sah},
           {"sah_sweep", BihSplit::sah_sweep},
           {"global", BihSplit::global}},
          "primitives divided by cost at borders of bins or by an exact sweep, or by the middle of "
          "the scene's box, halved again and again"),
      option("planes", &O::planes, {{"parallel", BihPlanes::parallel}, {"free", BihPlanes::free}},
             "both planes on the axis that was divided, or each child cut by the face of its box "
             "that leaves the least area"),
      option("trim", &O::trim, 0.0, 1.0,
             "inner nodes are cut by two more planes along axes of which they fill less than this "
             "part; 0: never"),
      option("bins", &O::bins, 2, 256, "bins per axis of split=sah"),
      option("leaf_size", &O::leaf_size, 1, 1024, "most primitives in a leaf"),
      option("traverse_cost", &O::traverse_cost, 0.001, 1000.0, "cost of a node step"),
      option("intersect_cost", &O::intersect_cost, 0.001, 1000.0, "cost of a primitive test"),
  };
}

Bih::Bih(const PrimitiveSource& source, const Options& options, const BuildContext& context)
    : reference_cost_(options.intersect_cost / options.traverse_cost) {
  std::vector<PrimRef> refs = make_prim_refs(source, context);
  if (refs.empty()) return;
  for (const PrimRef& ref : refs) root_box_.extend(ref.box);
  MemoryMeter meter(context, "bih");
  const bool sweeps = options.split == BihSplit::sah_sweep;
  const MemoryLease tree_lease(meter, refs.size() * kTreeBytes);
  MemoryLease build_lease(meter, refs.size() * (sizeof(PrimRef) + (sweeps ? kSweepBytes : 0)));
  Tree tree = divide(std::move(refs), root_box_, options, context);
  build_lease = MemoryLease();
  BihLayout layout(tree, options, meter);
  tree_.nodes = layout.run();
  tree_.references = std::move(tree.references);
  tree_.references.shrink_to_fit();
  report_ = layout.report();
  report_.bytes = tree_.nodes.capacity() * sizeof(BihNode) +
                  tree_.references.capacity() * sizeof(std::uint32_t);
}

void Bih::validate(const PrimitiveSource& source) const {
  validate_bih(tree_, root_box_, report_, source);
}

BoxTree Bih::box_tree() const {
  BoxTree out{{std::vector<HierarchyNode>(tree_.nodes.size()), tree_.references},
              {1.0, 0.0, reference_cost_}};
  std::vector<HierarchyNode>& nodes = out.nodes.nodes;
  if (!nodes.empty()) nodes[0].box = root_box_;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const BihNode& from = tree_.nodes[i];
    if (from.is_leaf()) {
      nodes[i].first = from.first(), nodes[i].count = from.count();
      continue;
    }
    nodes[i].first = from.child(), nodes[i].children = from.is_trimmed() ? 1 : 2;
    for (std::uint32_t c = 0; c < nodes[i].children; ++c)
      nodes[from.child() + c].box = child_box(from, c, nodes[i].box);
  }
  return out;
}

void Bih::hash_into(Hash64& hash) const {
  for (const BihNode& node : tree_.nodes) node.hash_into(hash);
  hash.add(std::span<const std::uint32_t>(tree_.references));
}

}  // namespace strahl
