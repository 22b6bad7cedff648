#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include <strahl/math/float_round.h>
#include <strahl/structures/wide_bvh/wide_filter.h>
#include <strahl/structures/wide_bvh/wide_write.h>

namespace strahl {
namespace {

const Vec3f kNoCorner = Vec3f::all(std::numeric_limits<float>::quiet_NaN());

float* planes_of(std::byte* node) { return reinterpret_cast<float*>(node); }

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

}  // namespace

void clear_boxes(std::byte* node, int width) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::fill_n(planes_of(node), 3 * width, kInfinity);
  std::fill_n(planes_of(node) + 3 * width, 3 * width, -kInfinity);
}

void write_box(std::byte* node, int width, int slot, const Aabb& box, const WideFrame& frame) {
  const Vec3d lo = frame.to_frame(box.lo), hi = frame.to_frame(box.hi);
  const double off = frame.rounding();
  for (int axis = 0; axis < 3; ++axis) {
    planes_of(node)[axis * width + slot] = float_below(lo[axis] - off);
    planes_of(node)[(axis + 3) * width + slot] = float_above(hi[axis] + off);
  }
}

void write_block(std::byte* block, std::span<const std::uint32_t> references,
                 const WideFrame& frame, const PrimitiveSource& source) {
  const auto lanes = static_cast<std::uint32_t>(references.size());
  std::array<TriangleVertices, kWideMaxLanes> triangles;
  std::array<LaneCorners, kWideMaxLanes> corners;
  source.triangles(references, triangles.data());
  if (frame.is_identity() && write_float_corners(block, std::span(triangles).first(lanes))) return;
  for (std::uint32_t i = 0; i < lanes; ++i) {
    const bool is_triangle = !std::isnan(triangles[i].a.x);
    corners[i] = is_triangle ? lane_corners(triangles[i], frame) : LaneCorners{};
    if (is_triangle)
      write_lane(block, lanes, i, {corners[i].a, corners[i].b, corners[i].c});
    else
      write_lane(block, lanes, i, {kNoCorner, kNoCorner, kNoCorner});
  }
  const LeafBound bound = leaf_bound(std::span(corners).first(lanes));
  std::memcpy(block, &bound, sizeof bound);
}

}  // namespace strahl
