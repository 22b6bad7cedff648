#include <span>
#include <utility>

#include <strahl/structures/ternary_tree/ternary_build.h>
#include <strahl/structures/ternary_tree/ternary_tree.h>

namespace strahl {

OptionTable<TernaryTreeOptions> option_fields(const TernaryTreeOptions*) {
  using O = TernaryTreeOptions;
  return {
      option("rule", &O::rule,
             {{"sides", OversizeRule::sides},
              {"area", OversizeRule::area},
              {"median", OversizeRule::median}},
             "oversized are primitives that are long on two axes of the cell, large by area, or "
             "large beside the median of their cell"),
      option("threshold", &O::threshold, 0.01, 1.0,
             "part of the cell's side or area from which on a primitive is oversized"),
      option("median_factor", &O::median_factor, 1.0, 1000000.0,
             "multiple of the median area from which on a primitive is oversized"),
      option("keep", &O::keep,
             {{"auto", OversizeKeep::automatic},
              {"list", OversizeKeep::list},
              {"tree", OversizeKeep::tree}},
             "oversized primitives are a list or have a tree of their own; auto: by list_max"),
      option("list_max", &O::list_max, 0, 1000000, "longest list of keep=auto"),
      option("decide", &O::decide,
             {{"cost", OversizeDecision::cost}, {"always", OversizeDecision::always}},
             "oversized primitives are taken out where that is expected to be cheaper, or wherever "
             "the rest is divided"),
      option("order", &O::order, {{"first", OversizeOrder::first}, {"last", OversizeOrder::last}},
             "whether rays meet the oversized primitives before or after the rest of the cell"),
      option("split", &O::split,
             {{"auto", TernarySplit::automatic},
              {"sah_sweep", TernarySplit::sah_sweep},
              {"sah_binned", TernarySplit::sah_binned}},
             "plane at any end of a primitive or at borders of bins (auto: ends for up to 500,000 "
             "primitives)"),
      option("bins", &O::bins, 2, 1024, "bins per axis where planes are binned"),
      option("clip", &O::clip, "bound the part of a primitive inside the cell, not all of it"),
      option("traverse_cost", &O::traverse_cost, 0.001, 1000.0, "cost of a traversal step"),
      option("intersect_cost", &O::intersect_cost, 0.001, 1000.0, "cost of a primitive test"),
      option("max_depth", &O::max_depth, 0, TernaryTree::kMaxDepth,
             "depth of leaves at most; 0: 8 + 1.3 log2 of the primitives"),
      option("max_growth", &O::max_growth, 1.0, 1000000.0,
             "references per primitive at most; cells share what is left by their contents"),
  };
}

TernaryTree::TernaryTree(const PrimitiveSource& source, const Options& options,
                         const BuildContext& context)
    : cost_{options.traverse_cost, options.intersect_cost},
      oversized_first_(options.order == OversizeOrder::first) {
  std::vector<PrimRef> refs = make_prim_refs(source, context);
  for (const PrimRef& ref : refs) root_box_.extend(ref.box);
  max_depth_ = kd_depth_limit(options.max_depth, kMaxDepth, refs.size());
  tree_ = build_ternary_tree(source, std::move(refs), root_box_, options, context, report_);
}

void TernaryTree::validate(const PrimitiveSource& source) const {
  validate_kd_tree(tree_, {kName, root_box_, max_depth_, cost_, true, report_}, source);
}

void TernaryTree::hash_into(Hash64& hash) const {
  for (const KdNode& node : tree_.nodes) node.hash_into(hash);
  hash.add(std::span<const std::uint32_t>(tree_.references));
}

}  // namespace strahl
