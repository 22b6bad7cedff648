#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include <strahl/math/float_round.h>
#include <strahl/structures/wide_bvh/wide_any_order.h>
#include <strahl/structures/wide_bvh/wide_filter.h>
#include <strahl/structures/wide_bvh/wide_write.h>

namespace strahl {
namespace {

const Vec3f kNoCorner = Vec3f::all(std::numeric_limits<float>::quiet_NaN());

float* planes_of(std::byte* node) { return reinterpret_cast<float*>(node); }

void put_ordered_slot(std::byte* node, int lane, std::uint32_t slot) {
  float& plane = planes_of(node)[lane];
  plane = with_ordered_slot(plane, slot);
}

void write_lane(std::byte* block, std::uint32_t lanes, std::uint32_t lane, const Vec3f (&abc)[3]) {
  auto* rows = reinterpret_cast<float*>(block + sizeof(LeafBound));
  for (std::uint32_t row = 0; row < 9; ++row)
    rows[row * lanes + lane] = abc[row / 3][static_cast<int>(row % 3)];
}

/// Corners that are floats of the frame, as those of most scenes are, with their bounds.
/// @returns false, and nothing is of use, where some are not
bool write_float_corners(std::byte* block, std::span<const TriangleVertices> triangles) {
  auto* rows = reinterpret_cast<float*>(block + sizeof(LeafBound));
  const std::size_t lanes = triangles.size();
  double longest = 0.0;
  bool are_floats = true;
  for (std::size_t i = 0; i < lanes; ++i) {
    const TriangleVertices& t = triangles[i];
    const Vec3d ab = t.b - t.a, ac = t.c - t.a;
    longest = std::max({longest, dot(ab, ab), dot(ac, ac)});
    const double values[9] = {t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z};
    for (std::size_t row = 0; row < 9; ++row) {
      const auto value = static_cast<float>(values[row]);
      are_floats &= static_cast<double>(value) == values[row];
      rows[row * lanes + i] = value;
    }
  }
  const LeafBound bound = leaf_bound(longest, 0.0);
  std::memcpy(block, &bound, sizeof bound);
  return are_floats;
}

/// Corners as stored, and their bounds.
void write_corners(std::byte* block, const BlockCorners& corners) {
  for (std::uint32_t i = 0; i < corners.lanes; ++i) {
    const LaneCorners& at = corners.stored[i];
    write_lane(block, corners.lanes, i, {at.a, at.b, at.c});
  }
  const LeafBound bound = leaf_bound(std::span(corners.stored).first(corners.lanes));
  std::memcpy(block, &bound, sizeof bound);
}

/// @param triangles NaN for things that are none
BlockCorners corners_of(std::span<const TriangleVertices> triangles, const WideFrame& frame) {
  BlockCorners corners;
  for (const TriangleVertices& triangle : triangles) {
    const std::uint32_t i = corners.lanes++;
    if (std::isnan(triangle.a.x)) {
      corners.stored[i] = {kNoCorner, kNoCorner, kNoCorner};
      corners.all_triangles = false;
      continue;
    }
    corners.stored[i] = lane_corners(triangle, frame);
    corners.in_frame[i] = {frame.to_frame(triangle.a), frame.to_frame(triangle.b),
                           frame.to_frame(triangle.c)};
  }
  return corners;
}

/// Triangles of references, asked for at once.
class BlockTriangles {
 public:
  BlockTriangles(std::span<const std::uint32_t> references, const PrimitiveSource& source)
      : count_(references.size()) {
    source.triangles(references, triangles_.data());
  }
  std::span<const TriangleVertices> all() const { return std::span(triangles_).first(count_); }

 private:
  std::array<TriangleVertices, kWideMaxLanes> triangles_;
  std::size_t count_;
};

/// Seen along the axes, summed.
double triangle_area(std::span<const TriangleVertices> triangles) {
  double twice = 0.0;
  for (const TriangleVertices& t : triangles) twice += norm1(cross(t.b - t.a, t.c - t.a));
  return twice / 2;
}

}  // namespace

void clear_boxes(std::byte* node, int width) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::fill_n(planes_of(node), 3 * width, kInfinity);
  std::fill_n(planes_of(node) + 3 * width, 3 * width, -kInfinity);
}

void write_box(std::byte* node, int width, int slot, const Aabb& box, const WideFrame& frame) {
  const Vec3d lo = frame.to_frame(box.lo), hi = frame.to_frame(box.hi);
  const double off = frame.rounding();
  const std::uint32_t ordered = ordered_slot(planes_of(node)[slot]);
  for (int axis = 0; axis < 3; ++axis) {
    planes_of(node)[axis * width + slot] = float_below(lo[axis] - off);
    planes_of(node)[(axis + 3) * width + slot] = float_above(hi[axis] + off);
  }
  if (width == kOrderedWidth) put_ordered_slot(node, slot, ordered);
}

void write_any_order(std::byte* node, std::span<const Blocking, kOrderedWidth> children) {
  int lane = 0;
  for (const std::uint32_t slot : any_order(children)) put_ordered_slot(node, lane++, slot);
}

BlockSizes block_sizes(std::span<const std::uint32_t> references, const WideTree& tree,
                       const PrimitiveSource& source) {
  const std::size_t full = leaf_bytes(references.size());
  if (tree.layout == WideLayout::full) return {full, full};
  return compact_sizes(corners_of(BlockTriangles(references, source).all(), tree.frame));
}

WrittenBlock write_block(std::byte* block, std::span<const std::uint32_t> references,
                         const WideTree& tree, const PrimitiveSource& source, std::size_t bytes) {
  const BlockTriangles triangles(references, source);
  const double area = triangle_area(triangles.all()) * tree.frame.scale * tree.frame.scale;
  if (tree.layout == WideLayout::compact)
    return {write_compact_block(block, corners_of(triangles.all(), tree.frame), bytes), area};
  if (!tree.frame.is_identity() || !write_float_corners(block, triangles.all()))
    write_corners(block, corners_of(triangles.all(), tree.frame));
  return {true, area};
}

}  // namespace strahl
