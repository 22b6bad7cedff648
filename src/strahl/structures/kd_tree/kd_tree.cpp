#include <span>
#include <utility>

#include <strahl/structures/kd_tree/kd_build.h>
#include <strahl/structures/kd_tree/kd_tree.h>

namespace strahl {
OptionTable<KdTreeOptions> option_fields(const KdTreeOptions*) {
  using O = KdTreeOptions;
  return {
      option("split", &O::split,
             {{"auto", KdSplit::automatic},
              {"sah_sweep", KdSplit::sah_sweep},
              {"sah_binned", KdSplit::sah_binned},
              {"middle", KdSplit::middle},
              {"median", KdSplit::median}},
             "plane by cost at any end of a primitive or at borders of bins (auto: ends for up to "
             "500,000 primitives), or the middle of the cell or of its primitives"),
      option("axis", &O::axis, {{"longest", KdAxis::longest}, {"round_robin", KdAxis::round_robin}},
             "axis of planes in the middle or at the median"),
      option("bins", &O::bins, 2, 1024, "bins per axis where planes are binned"),
      option("clip", &O::clip, "bound the part of a primitive inside the cell, not all of it"),
      option("traverse_cost", &O::traverse_cost, 0.001, 1000.0, "cost of a traversal step"),
      option("intersect_cost", &O::intersect_cost, 0.001, 1000.0, "cost of a primitive test"),
      option("empty_bonus", &O::empty_bonus, 0.0, 1.0,
             "part of the cost forgiven to planes that cut off empty space"),
      option("max_leaf", &O::max_leaf, 1, 1000000, "primitives that are never divided"),
      option("max_depth", &O::max_depth, 0, KdTree::kMaxDepth,
             "depth of leaves at most; 0: 8 + 1.3 log2 of the primitives"),
      option("bad_splits", &O::bad_splits, 0, 8,
             "planes on a path that may cost more than a leaf of 16 primitives or more"),
      option("max_growth", &O::max_growth, 1.0, 1000000.0,
             "references per primitive at most; cells share what is left by their contents"),
      option("traversal", &O::traversal,
             {{"stack", KdTraversal::stack},
              {"havran", KdTraversal::havran},
              {"skip", KdTraversal::skip},
              {"ropes", KdTraversal::ropes}},
             "with a stack of intervals or of points; without one: by skip pointers, depth first, "
             "or by ropes from cell to cell"),
      option("node_bytes", &O::node_bytes,
             {{"8", KdNodeBytes::b8},
              {"16", KdNodeBytes::b16},
              {"32", KdNodeBytes::b32},
              {"64", KdNodeBytes::b64}},
             "distance of nodes in memory; more than 8 is padding, to measure with"),
  };
}

KdTree::KdTree(const PrimitiveSource& source, const Options& options, const BuildContext& context)
    : traversal_(options.traversal), cost_{options.traverse_cost, options.intersect_cost} {
  std::vector<PrimRef> refs = make_prim_refs(source, context);
  for (const PrimRef& ref : refs) root_box_.extend(ref.box);
  max_depth_ = kd_depth_limit(options.max_depth, kMaxDepth, refs.size());
  KdArrays tree = build_kd_tree(source, std::move(refs), root_box_, options, context);
  report_ = report_kd_tree(tree, root_box_, cost_);
  take(std::move(tree), options, context);
}

/// Lays the tree out for its traversal.
void KdTree::take(KdArrays tree, const Options& options, const BuildContext& context) {
  references_ = std::move(tree.references);
  const std::uint64_t others = references_.capacity() * sizeof(std::uint32_t);
  nodes_ = KdNodes(std::move(tree.nodes), options.node_bytes, others, context);
  const std::uint64_t owned = others + nodes_.bytes();
  if (traversal_ == KdTraversal::skip) links_ = make_gates(nodes_, root_box_, owned, context);
  if (traversal_ == KdTraversal::ropes) links_ = make_ropes(nodes_, root_box_, owned, context);
  report_.bytes = owned + links_.bytes();
}

void KdTree::validate(const PrimitiveSource& source) const {
  validate_kd_tree({nodes_.packed(), references_},
                   {kName, root_box_, max_depth_, cost_, false, report_}, source);
  if (traversal_ == KdTraversal::skip) check_gates(links_, nodes_, root_box_);
  if (traversal_ == KdTraversal::ropes) check_ropes(links_, nodes_, root_box_);
}

void KdTree::hash_into(Hash64& hash) const {
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i].hash_into(hash);
  hash.add(std::span<const std::uint32_t>(references_));
}

}  // namespace strahl
