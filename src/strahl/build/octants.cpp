#include <algorithm>
#include <span>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/build/octants.h>
#include <strahl/build/sah.h>

namespace strahl {

/// Gives the nodes, which come depth first, their places in blocks, and surveys them.
class OctantLayout {
 public:
  OctantLayout(OctantTree& tree, const OctantParts& parts) : tree_(tree), parts_(parts) {
    const auto inner = std::count_if(parts.nodes.begin(), parts.nodes.end(),
                                     [](const OctantParts::Node& node) { return node.is_inner; });
    tree_.nodes_.resize(parts.nodes.size());
    if (tree_.options_.traversal == OctantTraversal::neighbour) {
      tree_.parents_.resize(static_cast<std::size_t>(inner));
      tree_.reaches_.resize(static_cast<std::size_t>(inner));
    }
  }

  void place(std::uint32_t index, const Aabb& reach, std::uint64_t depth) {
    const OctantParts::Node& part = parts_.nodes[next_node_++];
    OctantNode& node = tree_.nodes_[index];
    node.first = next_reference_, node.count = part.count;
    next_reference_ += part.count;
    survey(part, reach, depth);
    if (!part.is_inner) return;
    node.block = next_block_++;
    if (!tree_.parents_.empty())
      tree_.parents_[node.block] = index, tree_.reaches_[node.block] = reach;
    place_children(node.block, reach, depth);
  }

 private:
  void place_children(std::uint32_t block, const Aabb& reach, std::uint64_t depth) {
    const OctantAxes& axes = tree_.axes_;
    for (std::uint32_t c = 0; c < axes.children(); ++c)
      place(tree_.child(block) + c, tree_.part(reach, block, c), depth + 1);
  }

  void survey(const OctantParts::Node& part, const Aabb& reach, std::uint64_t depth) {
    BuildReport& report = tree_.report_;
    report.leaves += !part.is_inner;
    report.empty_leaves += !part.is_inner && part.count == 0;
    report.depth = std::max(report.depth, depth);
    const double share = sah_share(reach.half_area(), tree_.box_.half_area());
    report.sah_cost += share * (part.is_inner + static_cast<double>(part.count));
  }

  OctantTree& tree_;
  const OctantParts& parts_;
  std::size_t next_node_ = 0;
  std::uint32_t next_block_ = 0, next_reference_ = 0;
};

OctantTree::OctantTree(const PrimitiveSource& source, const OctantOptions& options,
                       const OctantAxes& axes, const BuildContext& context, const char* what)
    : what_(what), options_(options), axes_(axes) {
  std::vector<PrimRef> refs = make_prim_refs(source, context);
  for (const PrimRef& ref : refs) box_.extend(ref.box);
  root_ = octant_root(box_, options);
  max_depth_ = octant_depth_limit(options, refs.size());
  stride_ = octant_stride(options);
  OctantParts parts = build_octants(source, std::move(refs), root_, options, axes, context, what);
  if (parts.nodes.size() > UINT32_MAX || parts.references.size() > UINT32_MAX)
    throw Error(ErrorCode::resource, "needs more than 2^32 cells or references", what);
  planes_ = std::move(parts.planes), references_ = std::move(parts.references);
  planes_.shrink_to_fit(), references_.shrink_to_fit();
  OctantLayout(*this, parts).place(0, box_, 0);
  report_.nodes = nodes_.size();
  report_.references = references_.size();
  report_.bytes = nodes_.capacity() * sizeof(OctantNode) + planes_.capacity() * sizeof(Vec3d) +
                  (references_.capacity() + parents_.capacity()) * sizeof(std::uint32_t) +
                  reaches_.capacity() * sizeof(Aabb);
}

Aabb OctantTree::part(const Aabb& whole, std::uint32_t block, std::uint32_t place) const {
  Aabb part = whole;
  for (int k = 0; k < axes_.count; ++k) {
    const int axis = axes_[k];
    const bool is_above = axes_.is_above(place, k);
    if (is_above || is_loose())
      part.lo[axis] = std::max(part.lo[axis], is_above ? begin(block)[axis] : low(block)[axis]);
    if (!is_above || is_loose())
      part.hi[axis] = std::min(part.hi[axis], is_above ? high(block)[axis] : end(block)[axis]);
  }
  return part;
}

void OctantTree::hash_into(Hash64& hash) const {
  for (const OctantNode& node : nodes_) hash.add(node.block), hash.add(node.count);
  for (const Vec3d& plane : planes_) hash.add(plane.x), hash.add(plane.y), hash.add(plane.z);
  hash.add(std::span<const std::uint32_t>(references_));
}

}  // namespace strahl
