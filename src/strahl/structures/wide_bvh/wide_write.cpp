#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include <strahl/math/float_round.h>
#include <strahl/structures/wide_bvh/wide_compact.h>
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

void write_full_block(std::byte* block, std::span<const std::uint32_t> references,
                      const WideFrame& frame, const PrimitiveSource& source) {
  const auto lanes = static_cast<std::uint32_t>(references.size());
  const Vec3f nan = Vec3f::all(std::numeric_limits<float>::quiet_NaN());
  std::array<LaneCorners, kWideMaxLanes> corners;
  for (std::uint32_t i = 0; i < lanes; ++i) {
    TriangleVertices triangle;
    const bool is_triangle = source.triangle(references[i], triangle);
    if (is_triangle) corners[i] = lane_corners(triangle, frame);
    const LaneCorners& at = corners[i];
    write_lane(block, lanes, i,
               {is_triangle ? at.a : nan, is_triangle ? at.b : nan, is_triangle ? at.c : nan});
  }
  const LeafBound bound = leaf_bound(std::span(corners).first(lanes));
  std::memcpy(block, &bound, sizeof bound);
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

void write_block(std::byte* block, std::span<const std::uint32_t> references, const WideTree& tree,
                 const PrimitiveSource& source) {
  if (tree.layout == WideLayout::compact)
    write_compact_block(block, references, tree.frame, source);
  else
    write_full_block(block, references, tree.frame, source);
}

}  // namespace strahl
