#include <algorithm>
#include <stdexcept>
#include <string>

#include <strahl/build/object_tree.h>
#include <strahl/math/float_round.h>
#include <strahl/structures/bvh/bvh.h>

namespace strahl {
namespace {

/// What both splitters need at their peak, per primitive, and the finished tree.
constexpr std::uint64_t kSweepBytes = 3 * 4 + 1 + 8 + 4, kTreeBytes = 2 * sizeof(TreeNode) + 4;

Aabb box_of(const float (&lo)[3], const float (&hi)[3]) {
  return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
}

[[noreturn]] void broken(std::size_t node, const char* what) {
  throw std::logic_error("bvh: node " + std::to_string(node) + ": " + what);
}

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
  report_.sah_cost = tree.sah_cost(cost_);
}

void Bvh::validate_children(std::size_t node) const {
  const Node& parent = nodes_[node];
  if (parent.first + 1 >= nodes_.size() || parent.first <= node) broken(node, "children misplaced");
  for (std::size_t child = parent.first; child < parent.first + 2; ++child)
    if (!box_of(parent.lo, parent.hi).contains(box_of(nodes_[child].lo, nodes_[child].hi)))
      broken(node, "its box does not enclose a child's");
}

void Bvh::validate(const PrimitiveSource& source) const {
  std::vector<int> seen(source.size(), 0);
  std::size_t leaves = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].count == 0) {
      validate_children(i);
      continue;
    }
    ++leaves;
    for (const std::uint32_t reference : references(static_cast<std::uint32_t>(i))) {
      if (!box_of(nodes_[i].lo, nodes_[i].hi).contains(source.bounds(reference)))
        broken(i, "its box does not enclose a primitive");
      ++seen[reference];
    }
  }
  if (!nodes_.empty() && nodes_.size() != 2 * leaves - 1) broken(0, "not a binary tree");
  if (report_.depth > kMaxDepth) broken(0, "deeper than the limit");
  for (std::uint32_t i = 0; i < source.size(); ++i)
    if (seen[i] != (source.bounds(i).is_empty() ? 0 : 1))
      throw std::logic_error("bvh: primitive " + std::to_string(i) + " is in " +
                             std::to_string(seen[i]) + " leaves");
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
