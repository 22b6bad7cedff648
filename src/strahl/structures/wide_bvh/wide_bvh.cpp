#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include <strahl/build/float_tree.h>
#include <strahl/build/linked_tree.h>
#include <strahl/build/optimise.h>
#include <strahl/build/reinsert_top.h>
#include <strahl/build/spatial_tree.h>
#include <strahl/structures/wide_bvh/wide_bvh.h>
#include <strahl/structures/wide_bvh/wide_estimate.h>
#include <strahl/structures/wide_bvh/wide_filter.h>
#include <strahl/structures/wide_bvh/wide_layout.h>
#include <strahl/structures/wide_bvh/wide_refit.h>
#include <strahl/structures/wide_bvh/wide_refs.h>

namespace strahl {
namespace {

/// Most bytes at a time per primitive of binary tree and collapse.
std::uint64_t tree_bytes(int width) {
  return 2 * sizeof(TreeNode) + sizeof(std::uint32_t) + Collapse::bytes(2, width);
}

int width_of(const WideBvhOptions& options, const WideKernel& kernel) {
  if (options.width == WideWidth::automatic) return kernel.best_width;
  return options.width == WideWidth::sixteen ? 16 : 8;
}

/// Whether all triangles have float corners.
bool have_float_corners(std::span<const PrimRef> refs, const PrimitiveSource& source) {
  return source.stores_floats() || std::all_of(refs.begin(), refs.end(), [&](const PrimRef& ref) {
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

/// A binary tree over a source, empty when nothing can be hit.
struct BinaryTree {
  Tree tree;
  WideFrame frame;      ///< that suits it
  WideFrame box_frame;  ///< of the boxes into that
  bool all_floats = false;
};

/// References there may be more than things, per thing, where the default cuts them: for 56 bytes
/// per triangle and 36 in compact blocks. Trees of 8 children need nearly that without any cut.
double growth_of(const WideBvhOptions& options, int width) {
  if (width == 16) return 0.12;
  return options.layout == WideLayout::compact ? 0.0 : 0.02;
}

/// In boxes of floats.
BinaryTree divide_floats(const PrimitiveSource& source, const WideBvhOptions& options,
                         const CollapseRules& wide, const BuildContext& context) {
  const bool is_fast = options.quality == WideQuality::fast;
  const double growth = is_fast ? 0.0 : growth_of(options, wide.width);
  WideRefs refs = make_wide_refs(source, context, growth);
  BinaryTree binary{{}, refs.frame, {}, refs.all_floats};
  if (refs.count == 0) return binary;
  FloatTreeRules rules;
  rules.bins = is_fast ? 8 : 32, rules.max_depth = kWideMaxDepth;
  // So few make a block anyway.
  rules.undivided = std::min<std::size_t>(is_fast ? 12 : 3, wide.max_leaf);
  if (is_fast) rules.cluster = 16, rules.opened = 512;
  context.require_memory((refs.count + refs.spare) *
                             (sizeof(FloatRef) + float_tree_bytes(rules) + tree_bytes(wide.width)),
                         "wide_bvh");
  if (is_fast) {
    binary.tree = build_float_tree(refs.refs(), rules, context);
    return binary;
  }
  binary.tree = build_cut_float_tree(refs.with_spare(), refs.count, rules, FloatCutRules(),
                                     WideThings(source, binary.frame), context);
  refs.room.reset();  // what follows needs the memory
  TopRules top;
  top.max_depth = kWideMaxDepth;
  binary.tree = reinsert_top(std::move(binary.tree), top, context);
  return binary;
}

/// In doubles; moves nodes afterwards.
BinaryTree divide_doubles(const PrimitiveSource& source, const CollapseRules& wide,
                          const BuildContext& context) {
  std::vector<PrimRef> refs = make_prim_refs(source, context);
  BinaryTree binary;
  if (refs.empty()) return binary;
  context.require_memory(refs.size() * (sizeof(PrimRef) + tree_bytes(wide.width)), "wide_bvh");
  Aabb box;
  for (const PrimRef& ref : refs) box.extend(ref.box);
  binary.all_floats = have_float_corners(refs, source);
  binary.frame = binary.box_frame = make_wide_frame(box);
  SpatialRules rules;
  rules.max_depth = kWideMaxDepth;
  binary.tree = build_spatial_tree(source, std::move(refs), box, rules, context);
  binary.tree = reinserted(std::move(binary.tree), context);
  return binary;
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
  CollapseRules rules;
  rules.width = width_of(options, *kernel_);
  rules.max_leaf = static_cast<std::size_t>(
      options.leaf_size > 0 ? std::min(options.leaf_size, rules.width) : rules.width);
  const BinaryTree binary = options.quality == WideQuality::high
                                ? divide_doubles(source, rules, context)
                                : divide_floats(source, options, rules, context);
  if (binary.tree.nodes.empty()) return;
  const Collapse collapse(binary.tree, rules, context);
  report_.sah_cost = built_cost_ = collapse.cost();
  WideTree empty;
  empty.width = rules.width, empty.layout = options.layout, empty.frame = binary.frame;
  empty.has_exact_corners = binary.all_floats && binary.frame.is_identity();
  tree_ = lay_out_wide(binary.tree, collapse, binary.box_frame, std::move(empty), source, context,
                       report_);
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
