#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include <strahl/build/linked_tree.h>
#include <strahl/build/object_tree.h>
#include <strahl/build/optimise.h>
#include <strahl/build/spatial_tree.h>
#include <strahl/structures/wide_bvh/wide_bvh.h>
#include <strahl/structures/wide_bvh/wide_estimate.h>
#include <strahl/structures/wide_bvh/wide_filter.h>
#include <strahl/structures/wide_bvh/wide_layout.h>
#include <strahl/structures/wide_bvh/wide_refit.h>

namespace strahl {
namespace {

/// Most bytes at a time per primitive: references, the binary tree, the choices of the collapse.
std::uint64_t bytes_per_primitive(int width) {
  return sizeof(PrimRef) + 2 * sizeof(TreeNode) + sizeof(std::uint32_t) + Collapse::bytes(2, width);
}

int width_of(const WideBvhOptions& options, const WideKernel& kernel) {
  if (options.width == WideWidth::automatic) return kernel.best_width;
  return options.width == WideWidth::sixteen ? 16 : 8;
}

/// Whether all things are triangles with float corners.
bool have_float_corners(std::span<const PrimRef> refs, const PrimitiveSource& source) {
  return std::all_of(refs.begin(), refs.end(), [&](const PrimRef& ref) {
    TriangleVertices triangle;
    return !source.triangle(ref.reference, triangle) || has_float_corners(triangle);
  });
}

/// The tree with nodes moved to where they cost less.
Tree reinserted(Tree tree, const BuildContext& context) {
  // Nodes of both trees, and what a round needs per leaf.
  context.require_memory(tree.nodes.size() * (sizeof(TreeNode) + sizeof(LinkedNode)) +
                             reinsertion_bytes((tree.nodes.size() + 1) / 2),
                         "wide_bvh");
  LinkedTree linked = make_linked(tree);
  ReinsertionRules rules;
  rules.rounds = 4;  // brings most of what more would
  reinsert_nodes(linked, rules, context);
  return limit_depth(make_tree(linked), kWideMaxDepth, {1.0, 1.0}, context);
}

/// A binary tree down to very few references, which a block would hold anyway.
Tree build_binary(const PrimitiveSource& source, std::vector<PrimRef> refs, const Aabb& box,
                  WideQuality quality, std::size_t max_leaf, const BuildContext& context) {
  if (quality == WideQuality::high) {
    SpatialRules rules;
    rules.max_depth = kWideMaxDepth;
    return build_spatial_tree(source, std::move(refs), box, rules, context);
  }
  const bool is_fast = quality == WideQuality::fast;
  const auto splitter = make_binned_splitter(refs, is_fast ? 8 : 32, {1.0, 1.0});
  const std::size_t undivided = is_fast ? 8 : 3;  // so few make a block anyway
  const LeafRules rules{{1.0, 1.0}, 1, kWideMaxDepth, std::min(undivided, max_leaf)};
  return build_object_tree(*splitter, refs.size(), box, rules, context);
}

}  // namespace

OptionTable<WideBvhOptions> option_fields(const WideBvhOptions*) {
  return {
      option("quality", &WideBvhOptions::quality,
             {{"fast", WideQuality::fast},
              {"balanced", WideQuality::balanced},
              {"high", WideQuality::high}},
             "time spent on the tree"),
      option("width", &WideBvhOptions::width,
             {{"auto", WideWidth::automatic}, {"8", WideWidth::eight}, {"16", WideWidth::sixteen}},
             "children of a node (auto: what suits the instruction set)"),
      option("leaf_size", &WideBvhOptions::leaf_size, 0, static_cast<int>(kWideMaxLanes),
             "most primitives in a block; 0: the width"),
      option("layout", &WideBvhOptions::layout,
             {{"full", WideLayout::full}, {"compact", WideLayout::compact}},
             "corners in blocks: each as floats, or once, or rounded to 16 bits"),
      option("batch", &WideBvhOptions::batch,
             {{"interleaved", WideBatch::interleaved}, {"single", WideBatch::single}},
             "float rays of a batch: many under way at once, or one after the other"),
      option("rebuild_factor", &WideBvhOptions::rebuild_factor, 1.0, 1000.0,
             "when things move: built anew where fitting makes the SAH cost this times as high"),
  };
}

WideBvh::WideBvh(const PrimitiveSource& source, const Options& options, const BuildContext& context)
    : options_(options), kernel_(&wide_kernel_of_environment()), batch_(options.batch) {
  std::vector<PrimRef> refs = make_prim_refs(source, context);
  if (refs.empty()) return;
  const int width = width_of(options, *kernel_);
  context.require_memory(refs.size() * bytes_per_primitive(width), "wide_bvh");
  Aabb box;
  for (const PrimRef& ref : refs) box.extend(ref.box);
  WideTree empty;
  empty.width = width, empty.layout = options.layout, empty.frame = make_wide_frame(box);
  empty.has_exact_corners = have_float_corners(refs, source) && empty.frame.is_identity();
  CollapseRules rules;
  rules.width = width;
  rules.max_leaf =
      static_cast<std::size_t>(options.leaf_size > 0 ? std::min(options.leaf_size, width) : width);
  Tree tree = build_binary(source, std::move(refs), box, options.quality, rules.max_leaf, context);
  if (options.quality == WideQuality::high) tree = reinserted(std::move(tree), context);
  const Collapse collapse(tree, rules, context);
  report_.sah_cost = built_cost_ = collapse.cost();
  tree_ = lay_out_wide(tree, collapse, std::move(empty), source, context, report_);
}

void WideBvh::refit(const PrimitiveSource& source, const BuildContext& context) {
  std::optional<FittedWideTree> fitted = fit_wide_tree(tree_, source, context);
  if (!fitted || fitted->cost > options_.rebuild_factor * built_cost_) {
    fitted.reset();
    *this = WideBvh(source, options_, context);
    return;
  }
  tree_ = std::move(fitted->tree);
  report_.sah_cost = fitted->cost;
  ++refits_;
}

std::uint64_t WideBvh::estimate_bytes(const PrimitiveSource& source, const Options& options,
                                      const BuildContext& context) {
  return estimate_wide_bytes(source, options, context);
}

void WideBvh::hash_into(Hash64& hash) const {
  hash.add(tree_.root), hash.add(tree_.width);
  const std::byte* data = tree_.arena.data();
  for (std::uint64_t i = 0; i + 8 <= tree_.arena.size(); i += 8) {
    std::uint64_t word;
    std::memcpy(&word, data + i, sizeof word);
    hash.add(word);
  }
}

}  // namespace strahl
