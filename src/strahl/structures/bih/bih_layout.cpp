#include <algorithm>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/math/float_round.h>
#include <strahl/structures/bih/bih_layout.h>

namespace strahl {
namespace {

std::uint32_t pack(const AxisSide& side) {
  return static_cast<std::uint32_t>(2 * side.axis) + (side.is_above ? 1u : 0u);
}
/// Planes never cut off what they stand for.
std::uint32_t stored(bool is_above, double plane) {
  return std::bit_cast<std::uint32_t>(is_above ? float_below(plane) : float_above(plane));
}
/// The side of the box's own face.
AxisSide face(const Aabb& box, int axis, bool is_above) {
  return {axis, is_above, (is_above ? box.lo : box.hi)[axis]};
}

}  // namespace

BihNode BihNode::inner(const AxisSide& left, const AxisSide& right, std::size_t child) {
  return {stored(left.is_above, left.plane), stored(right.is_above, right.plane),
          static_cast<std::uint32_t>(child) << 6 | pack(right) << 3 | pack(left)};
}

BihNode BihNode::trimmed(int axis, double lo, double hi, std::size_t child) {
  return {
      stored(true, lo), stored(false, hi),
      static_cast<std::uint32_t>(child) << 6 | static_cast<std::uint32_t>(axis) << 3 | kTrimmed};
}

std::vector<BihNode> BihLayout::run() {
  waiting_.push_back({0, add_places(1), tree_.nodes[0].box, 0});
  while (!waiting_.empty()) {
    const Waiting at = waiting_.back();
    waiting_.pop_back();
    place(at);
  }
  nodes_.shrink_to_fit();
  report_.nodes = nodes_.size();
  report_.sah_cost /= options_.traverse_cost;
  return std::move(nodes_);
}

/// Growing arrays own up to twice what they hold.
std::size_t BihLayout::add_places(std::size_t count) {
  const std::size_t place = nodes_.size();
  if (place + count > BihNode::kMaxIndex)
    throw Error(ErrorCode::resource, "needs more than 2^26 nodes", "bih");
  meter_.take(2 * count * sizeof(BihNode));
  nodes_.insert(nodes_.end(), count, BihNode::leaf(0, 0));
  return place;
}

void BihLayout::place(Waiting at) {
  if (tree_.nodes[at.from].is_leaf()) return place_leaf(at);
  trim(at);
  place_children(at);
}

/// One node per axis along which the primitives fill too little of the cell.
void BihLayout::trim(Waiting& at) {
  const Aabb& box = tree_.nodes[at.from].box;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(box.extent()[axis] < options_.trim * at.cell.extent()[axis])) continue;
    add_cost(at.cell, options_.traverse_cost);
    const std::size_t child = add_places(1);
    nodes_[at.to] = BihNode::trimmed(axis, box.lo[axis], box.hi[axis], child);
    at.cell.lo[axis] = box.lo[axis], at.cell.hi[axis] = box.hi[axis];
    at.to = child, ++at.depth;
  }
}

void BihLayout::place_leaf(const Waiting& at) {
  const TreeNode& leaf = tree_.nodes[at.from];
  nodes_[at.to] = BihNode::leaf(leaf.first, leaf.count);
  ++report_.leaves;
  report_.references += leaf.count;
  report_.depth = std::max(report_.depth, at.depth);
  add_cost(at.cell, sah_leaf_cost({options_.traverse_cost, options_.intersect_cost}, leaf.count));
}

void BihLayout::place_children(const Waiting& at) {
  const TreeNode& node = tree_.nodes[at.from];
  const Aabb& left_box = tree_.nodes[at.from + 1].box;
  const Aabb& right_box = tree_.nodes[node.right].box;
  const int axis = static_cast<int>(node.axis);
  const AxisSide left = choose_side(at.cell, left_box, face(left_box, axis, false));
  const AxisSide right = choose_side(at.cell, right_box, face(right_box, axis, true));
  add_cost(at.cell, options_.traverse_cost);
  const std::size_t child = add_places(2);
  nodes_[at.to] = BihNode::inner(left, right, child);
  waiting_.push_back({node.right, child + 1, right.cut(at.cell), at.depth + 1});
  waiting_.push_back({at.from + 1, child, left.cut(at.cell), at.depth + 1});
}

/// The face of the box that leaves the least area of the cell; ties keep the usual one.
AxisSide BihLayout::choose_side(const Aabb& cell, const Aabb& box, const AxisSide& usual) const {
  if (options_.planes == BihPlanes::parallel) return usual;
  AxisSide best = usual;
  for (int code = 0; code < 6; ++code) {
    const AxisSide side = face(box, code / 2, code % 2 != 0);
    if (side.cut(cell).half_area() < best.cut(cell).half_area()) best = side;
  }
  return best;
}

void BihLayout::add_cost(const Aabb& cell, double work) {
  report_.sah_cost += sah_share(cell.half_area(), tree_.nodes[0].box.half_area()) * work;
}

}  // namespace strahl
