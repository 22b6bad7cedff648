#include <utility>
#include <vector>

#include <strahl/build/object_tree.h>
#include <strahl/math/float_round.h>
#include <strahl/structures/bvh/bvh.h>

namespace strahl {
namespace {

/// What both splitters need at their peak, per primitive, and the finished tree.
constexpr std::uint64_t kSweepBytes = 3 * 4 + 1 + 8 + 4, kTreeBytes = 2 * sizeof(TreeNode) + 4;

}  // namespace

OptionTable<BvhOptions> option_fields(const BvhOptions*) {
  return {
      option("bv", &BvhOptions::bv, {{"aabb", BvhVolume::aabb}}, "bounding volume of the nodes"),
      option("builder", &BvhOptions::builder,
             {{"sah_sweep", BvhBuilder::sah_sweep}, {"sah_binned", BvhBuilder::sah_binned}},
             "how primitives are divided: exact sweep, or bins over the centres"),
      option("bins", &BvhOptions::bins, 2, 256, "bins per axis of sah_binned"),
      option("leaf_size", &BvhOptions::leaf_size, 1, 1024, "most primitives in a leaf"),
      option("traverse_cost", &BvhOptions::traverse_cost, 0.001, 1000.0, "cost of a node step"),
      option("intersect_cost", &BvhOptions::intersect_cost, 0.001, 1000.0,
             "cost of a primitive test"),
  };
}

Bvh::Bvh(const PrimitiveSource& source, const Options& options, const BuildContext& context)
    : cost_{options.traverse_cost, options.intersect_cost} {
  std::vector<PrimRef> refs = make_prim_refs(source, context);
  if (refs.empty()) return;
  const bool sweeps = options.builder == BvhBuilder::sah_sweep;
  context.require_memory(refs.size() * (sizeof(PrimRef) + kTreeBytes + (sweeps ? kSweepBytes : 0)),
                         "bvh");
  Aabb box;
  for (const PrimRef& ref : refs) box.extend(ref.box);
  const auto splitter =
      sweeps ? make_sweep_splitter(refs, cost_) : make_binned_splitter(refs, options.bins, cost_);
  const LeafRules rules{cost_, static_cast<std::size_t>(options.leaf_size), kMaxDepth};
  lay_out(build_object_tree(*splitter, refs.size(), box, rules, context));
}

Bvh::Node Bvh::make_node(const TreeNode& from) {
  Node node{};
  for (int axis = 0; axis < 3; ++axis) {
    node.lo[axis] = float_below(from.box.lo[axis]);
    node.hi[axis] = float_above(from.box.hi[axis]);
  }
  node.first = from.first, node.count = from.count;
  return node;
}

/// Places the children of every inner node side by side, pairs in depth-first order.
void Bvh::lay_out(const Tree& tree) {
  nodes_.reserve(tree.nodes.size());
  nodes_.push_back(make_node(tree.nodes[0]));
  std::vector<std::pair<std::uint32_t, std::uint32_t>> waiting{{0, 0}};  // tree node, own node
  while (!waiting.empty()) {
    const auto [from, to] = waiting.back();
    waiting.pop_back();
    if (tree.nodes[from].is_leaf()) continue;
    const auto pair = static_cast<std::uint32_t>(nodes_.size());
    nodes_[to].first = pair;
    const std::uint32_t right = tree.nodes[from].right;
    nodes_.push_back(make_node(tree.nodes[from + 1]));
    nodes_.push_back(make_node(tree.nodes[right]));
    waiting.push_back({right, pair + 1});
    waiting.push_back({from + 1, pair});
  }
  references_ = tree.references;
  report_.nodes = nodes_.size();
  report_.leaves = (nodes_.size() + 1) / 2;
  report_.references = references_.size();
  report_.depth = static_cast<std::uint64_t>(tree.depth());
  report_.bytes = nodes_.capacity() * sizeof(Node) + references_.capacity() * sizeof(std::uint32_t);
  report_.sah_cost = sah_cost();
}

double Bvh::sah_cost() const {
  const double whole = nodes_[0].box().half_area();
  double sum = 0.0;
  for (const Node& node : nodes_) {
    // Boxes beyond float's range are stored as infinite: every line is taken to meet all of them.
    const double share = whole < Aabb::kInf ? sah_share(node.box().half_area(), whole) : 1.0;
    sum += share * (node.count > 0 ? sah_leaf_cost(cost_, node.count) : cost_.traverse);
  }
  return sum / cost_.traverse;
}

void Bvh::hash_into(Hash64& hash) const {
  for (const Node& node : nodes_) {
    for (const float v : node.lo) hash.add(v);
    for (const float v : node.hi) hash.add(v);
    hash.add(node.first), hash.add(node.count);
  }
  hash.add(std::span<const std::uint32_t>(references_));
}

}  // namespace strahl
