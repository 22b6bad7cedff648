#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include <strahl/math/float_round.h>
#include <strahl/structures/wide_bvh/wide_compact.h>

namespace strahl {
namespace {

constexpr std::size_t kMostCorners = 3 * kWideMaxLanes;
constexpr std::uint32_t kInfiniteStep = 0xff;

/// Corners of a block in the frame: of lane i those at 3 i.
struct Corners {
  std::array<Vec3d, kMostCorners> at;
  std::size_t count = 0;
};

/// Whether all are triangles.
bool gather(std::span<const std::uint32_t> references, const WideFrame& frame,
            const PrimitiveSource& source, Corners& corners) {
  for (const std::uint32_t reference : references) {
    TriangleVertices triangle;
    if (!source.triangle(reference, triangle)) return false;
    for (const Vec3d& corner : {triangle.a, triangle.b, triangle.c})
      corners.at[corners.count++] = frame.to_frame(corner);
  }
  return true;
}

/// Exponent of the least power of two not below v > 0.
int exponent_above(double v) {
  int exponent;
  const double mantissa = std::frexp(v, &exponent);
  return mantissa == 0.5 ? exponent - 1 : exponent;
}

/// Where numbers count from and how far they step: as finely as 16 bits reach over all corners and
/// floats are exact.
struct Grid {
  Vec3d origin;
  int exponent;

  explicit Grid(std::span<const Vec3d> corners) {
    Aabb box;
    for (const Vec3d& corner : corners) box.extend(corner);
    const Vec3d size = box.hi - box.lo;
    const double extent = std::max({size.x, size.y, size.z});
    const double farthest = std::max(norm_max(box.lo), norm_max(box.hi));
    exponent = exponent_above(std::max({extent / 65534.0, farthest * 0x1p-23, 0x1p-120}));
    for (int axis = 0; axis < 3; ++axis) origin[axis] = std::floor(box.lo[axis] / step()) * step();
  }
  double step() const { return std::ldexp(1.0, exponent); }
  std::uint16_t number(double v, int axis) const {
    return static_cast<std::uint16_t>(std::nearbyint((v - origin[axis]) / step()));
  }
};

std::uint16_t* rows_of(std::byte* block, std::uint32_t lanes) {
  return const_cast<std::uint16_t*>(compact_row(block, lanes, 0));
}

void write_rows(std::byte* block, const Corners& corners, const Grid& grid) {
  const std::size_t lanes = corners.count / 3;
  std::uint16_t* rows = rows_of(block, static_cast<std::uint32_t>(lanes));
  for (std::size_t i = 0; i < corners.count; ++i)
    for (int axis = 0; axis < 3; ++axis)
      rows[(i % 3 * 3 + static_cast<std::size_t>(axis)) * lanes + i / 3] =
          grid.number(corners.at[i][axis], axis);
}

/// The length of the longest edge from a corner a as stored.
double longest_edge(const std::byte* block, std::uint32_t lanes) {
  double longest = 0.0;
  for (std::uint32_t lane = 0; lane < lanes; ++lane) {
    const TriangleVertices t = compact_corners(block, lanes, lane);
    longest = std::max({longest, length(t.b - t.a), length(t.c - t.a)});
  }
  return longest;
}

/// The upper bits of a float not below v.
std::uint32_t upper_bits(double v) {
  return (std::bit_cast<std::uint32_t>(float_above(v)) + 0xffu) & ~0xffu;
}

void write_head(std::byte* block, const CompactHead& head) {
  std::memcpy(block, &head, sizeof head);
}

}  // namespace

TriangleVertices compact_corners(const std::byte* leaf, std::uint32_t lanes, std::uint32_t lane) {
  const CompactHead& head = compact_head(leaf);
  double v[9];
  for (std::uint32_t row = 0; row < 9; ++row)
    v[row] = static_cast<double>(head.origin[row % 3]) +
             static_cast<double>(head.step()) * compact_row(leaf, lanes, row)[lane];
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}};
}

void write_compact_block(std::byte* block, std::span<const std::uint32_t> references,
                         const WideFrame& frame, const PrimitiveSource& source) {
  const auto lanes = static_cast<std::uint32_t>(references.size());
  Corners corners;
  if (!gather(references, frame, source, corners)) {
    std::fill_n(rows_of(block, lanes), 9 * lanes, std::uint16_t{0});
    return write_head(block, {{}, kInfiniteStep});
  }
  const Grid grid(std::span(corners.at).first(corners.count));
  write_rows(block, corners, grid);
  CompactHead head{{}, static_cast<std::uint32_t>(127 + grid.exponent)};
  for (int axis = 0; axis < 3; ++axis) head.origin[axis] = static_cast<float>(grid.origin[axis]);
  write_head(block, head);
  const double error = kCompactError * grid.step();
  head.word |= upper_bits(1.0001 * longest_edge(block, lanes) + 2 * error);
  write_head(block, head);
}

}  // namespace strahl
