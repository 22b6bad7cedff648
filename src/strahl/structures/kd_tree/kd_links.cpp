#include <limits>

#include <strahl/math/float_round.h>
#include <strahl/structures/kd_tree/kd_links.h>

namespace strahl {
namespace {

/// Nodes between two questions whether to go on.
constexpr std::size_t kCheckEvery = 1u << 14;
constexpr char kStage[] = "linking";

std::array<float, 3> rounded_down(const Vec3d& v) {
  return {float_below(v.x), float_below(v.y), float_below(v.z)};
}
std::array<float, 3> rounded_up(const Vec3d& v) {
  return {float_above(v.x), float_above(v.y), float_above(v.z)};
}

/// The cells on both sides of a node's plane.
std::pair<Aabb, Aabb> halves(const KdNode& node, const Aabb& cell) {
  Aabb below = cell, above = cell;
  below.hi[node.axis()] = above.lo[node.axis()] = node.plane();
  return {below, above};
}

void check_progress(std::size_t node, std::size_t nodes, const BuildContext& context) {
  if (node % kCheckEvery == 0)
    context.check(static_cast<double>(node) / static_cast<double>(nodes), kStage);
}

/// Makes gates in depth-first order.
class GateMaker {
 public:
  GateMaker(const KdNodes& nodes, const BuildContext& context, std::vector<Gate>& gates)
      : nodes_(nodes), context_(context), gates_(gates) {}

  /// @param end the node behind the subtree
  void visit(std::uint32_t index, const Aabb& cell, std::uint32_t end) {
    check_progress(index, nodes_.size(), context_);
    const KdNode& node = nodes_[index];
    if (node.is_leaf()) return;
    const auto [below, above] = halves(node, cell);
    visit(index + 1, below, node.right());
    gates_.push_back({rounded_down(above.lo), rounded_up(above.hi), end});
    visit(node.right(), above, end);
  }

 private:
  const KdNodes& nodes_;
  const BuildContext& context_;
  std::vector<Gate>& gates_;
};

using Ropes = std::array<std::uint32_t, 6>;

/// The smallest node within `rope` whose cell covers the face: a plane across the face stops it.
std::uint32_t push_down(const KdNodes& nodes, std::uint32_t rope, std::size_t face,
                        const Aabb& cell) {
  const int face_axis = static_cast<int>(face / 2);
  const bool is_upper = face % 2 == 1;
  while (rope != RopedCell::kNoRope && !nodes[rope].is_leaf()) {
    const KdNode& node = nodes[rope];
    const int axis = node.axis();
    const bool lies_below = axis == face_axis ? is_upper : cell.hi[axis] <= node.plane();
    const bool lies_above = axis == face_axis ? !is_upper : cell.lo[axis] >= node.plane();
    if (!lies_below && !lies_above) break;
    rope = lies_below ? rope + 1 : node.right();
  }
  return rope;
}

/// Hands ropes down: children have those of their parent, but for the face between them.
class RopeMaker {
 public:
  RopeMaker(const KdNodes& nodes, const BuildContext& context, KdLinks& links)
      : nodes_(nodes), context_(context), links_(links) {}

  void visit(std::uint32_t index, const Aabb& cell, Ropes ropes) {
    check_progress(index, nodes_.size(), context_);
    links_.place.push_back(static_cast<std::uint32_t>(links_.cells.size()));
    for (std::size_t face = 0; face < 6; ++face)
      ropes[face] = push_down(nodes_, ropes[face], face, cell);
    const KdNode& node = nodes_[index];
    if (node.is_leaf()) return add_cell(cell, ropes);
    const std::size_t lower = 2 * static_cast<std::size_t>(node.axis());
    const auto [below, above] = halves(node, cell);
    Ropes of_below = ropes, of_above = ropes;
    of_below[lower + 1] = node.right(), of_above[lower] = index + 1;
    visit(index + 1, below, of_below);
    visit(node.right(), above, of_above);
  }

 private:
  void add_cell(const Aabb& cell, const Ropes& ropes) {
    RopedCell roped;
    const auto lo = rounded_down(cell.lo), hi = rounded_up(cell.hi);
    for (std::size_t axis = 0; axis < 3; ++axis)
      roped.face[2 * axis] = lo[axis], roped.face[2 * axis + 1] = hi[axis];
    roped.rope = ropes;
    links_.cells.push_back(roped);
  }

  const KdNodes& nodes_;
  const BuildContext& context_;
  KdLinks& links_;
};

}  // namespace

KdLinks make_gates(const KdNodes& nodes, const Aabb& root, std::uint64_t owned,
                   const BuildContext& context) {
  KdLinks links;
  const std::size_t inner = nodes.size() / 2;
  context.require_memory(owned + inner * sizeof(Gate), "kd_tree");
  links.gates.reserve(inner);
  GateMaker(nodes, context, links.gates).visit(0, root, static_cast<std::uint32_t>(nodes.size()));
  return links;
}

KdLinks make_ropes(const KdNodes& nodes, const Aabb& root, std::uint64_t owned,
                   const BuildContext& context) {
  KdLinks links;
  const std::size_t leaves = nodes.size() / 2 + 1;
  context.require_memory(owned + leaves * sizeof(RopedCell) + nodes.size() * sizeof(std::uint32_t),
                         "kd_tree");
  links.cells.reserve(leaves), links.place.reserve(nodes.size());
  Ropes none;
  none.fill(RopedCell::kNoRope);
  RopeMaker(nodes, context, links).visit(0, root, none);
  return links;
}

}  // namespace strahl
