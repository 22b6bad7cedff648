#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include <strahl/math/float_round.h>
#include <strahl/structures/wide_bvh/wide_filter.h>
#include <strahl/structures/wide_bvh/wide_write.h>

namespace strahl {
namespace {

float* planes_of(std::byte* node) { return reinterpret_cast<float*>(node); }

void write_lane(std::byte* block, std::uint32_t lanes, std::uint32_t lane, const Vec3f (&abc)[3]) {
  auto* rows = reinterpret_cast<float*>(block + sizeof(LeafBound));
  for (std::uint32_t row = 0; row < 9; ++row)
    rows[row * lanes + lane] = abc[row / 3][static_cast<int>(row % 3)];
}

void write_full_block(std::byte* block, const BlockCorners& corners) {
  for (std::uint32_t i = 0; i < corners.lanes; ++i) {
    const LaneCorners& at = corners.stored[i];
    write_lane(block, corners.lanes, i, {at.a, at.b, at.c});
  }
  const LeafBound bound = leaf_bound(std::span(corners.stored).first(corners.lanes));
  std::memcpy(block, &bound, sizeof bound);
}

BlockCorners corners_of(std::span<const std::uint32_t> references, const WideFrame& frame,
                        const PrimitiveSource& source) {
  const Vec3f nan = Vec3f::all(std::numeric_limits<float>::quiet_NaN());
  BlockCorners corners;
  for (const std::uint32_t reference : references) {
    const std::uint32_t i = corners.lanes++;
    TriangleVertices triangle;
    if (!source.triangle(reference, triangle)) {
      corners.stored[i] = {nan, nan, nan};
      corners.all_triangles = false;
      continue;
    }
    corners.stored[i] = lane_corners(triangle, frame);
    corners.in_frame[i] = {frame.to_frame(triangle.a), frame.to_frame(triangle.b),
                           frame.to_frame(triangle.c)};
  }
  return corners;
}

}  // namespace

void clear_boxes(std::byte* node, int width) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::fill_n(planes_of(node), 3 * width, kInfinity);
  std::fill_n(planes_of(node) + 3 * width, 3 * width, -kInfinity);
}

void write_box(std::byte* node, int width, int slot, const Aabb& box, const WideFrame& frame) {
  const Vec3d lo = frame.to_frame(box.lo), hi = frame.to_frame(box.hi);
  // to_frame() rounds by 2^-53 of its result; where it does, one float more is far enough.
  const double off = frame.is_identity() ? 0.0 : 0x1p-50 * frame.reach;
  for (int axis = 0; axis < 3; ++axis) {
    planes_of(node)[axis * width + slot] = float_below(lo[axis] - off);
    planes_of(node)[(axis + 3) * width + slot] = float_above(hi[axis] + off);
  }
}

BlockSizes block_sizes(std::span<const std::uint32_t> references, const WideTree& tree,
                       const PrimitiveSource& source) {
  const std::size_t full = leaf_bytes(references.size());
  if (tree.layout == WideLayout::full) return {full, full};
  return compact_sizes(corners_of(references, tree.frame, source));
}

bool write_block(std::byte* block, std::span<const std::uint32_t> references, const WideTree& tree,
                 const PrimitiveSource& source, std::size_t bytes) {
  const BlockCorners corners = corners_of(references, tree.frame, source);
  if (tree.layout == WideLayout::compact) return write_compact_block(block, corners, bytes);
  write_full_block(block, corners);
  return true;
}

}  // namespace strahl
