// geometry/point_tree.cpp - construction and marking.
#include <algorithm>
#include <numeric>

#include <strahl/geometry/point_tree.h>

namespace strahl {
namespace {

constexpr std::uint32_t kLeafSize = 16;
constexpr std::uint32_t kNoParent = 0xffffffffU;

}  // namespace

PointTree::PointTree(std::span<const Point2> points)
    : points_(points), order_(points.size()), leaf_of_(points.size()), marks_(points.size(), 0) {
  std::iota(order_.begin(), order_.end(), 0U);
  build(0, static_cast<std::uint32_t>(points.size()), kNoParent);
}

Box2 PointTree::box_of(std::uint32_t first, std::uint32_t end) const {
  Box2 box{points_[order_[first]], points_[order_[first]]};
  for (std::uint32_t slot = first + 1; slot < end; ++slot) {
    const Point2& p = points_[order_[slot]];
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
  }
  return box;
}

std::uint32_t PointTree::build(std::uint32_t first, std::uint32_t end, std::uint32_t parent) {
  const auto at = static_cast<std::uint32_t>(nodes_.size());
  const Box2 box = box_of(first, end);
  nodes_.push_back({box, first, end, parent});
  if (end - first <= kLeafSize) {
    for (std::uint32_t slot = first; slot < end; ++slot) leaf_of_[order_[slot]] = at;
    return at;
  }
  const bool by_x = box.high.x - box.low.x > box.high.y - box.low.y;
  const std::uint32_t middle = first + (end - first) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t i, std::uint32_t j) {
                     return by_x ? points_[i].x < points_[j].x : points_[i].y < points_[j].y;
                   });
  build(first, middle, at);
  const std::uint32_t right = build(middle, end, at);
  nodes_[at].right = right;
  return at;
}

void PointTree::set_marked(std::uint32_t i, bool marked) {
  if (marked == is_marked(i)) return;
  marks_[i] = marked ? 1 : 0;
  for (std::uint32_t at = leaf_of_[i]; at != kNoParent; at = nodes_[at].parent) {
    marked ? ++nodes_[at].marked : --nodes_[at].marked;
  }
}

}  // namespace strahl
