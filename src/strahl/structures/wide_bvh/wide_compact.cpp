#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <strahl/math/aabb.h>
#include <strahl/math/float_round.h>
#include <strahl/structures/wide_bvh/wide_compact.h>

namespace strahl {
namespace {

constexpr std::uint32_t kInfiniteStep = 0xff;

// --- Indexed blocks ---

/// Corners of a block that differ in their bits, and which of them each lane has.
struct Distinct {
  std::uint32_t count = 0;
  std::array<Vec3f, 3 * kWideMaxLanes> corners;
  std::array<std::array<std::uint8_t, kWideMaxLanes>, 3> index;

  explicit Distinct(const BlockCorners& block) {
    for (std::uint32_t lane = 0; lane < block.lanes; ++lane) {
      const LaneCorners& at = block.stored[lane];
      index[0][lane] = place_of(at.a), index[1][lane] = place_of(at.b);
      index[2][lane] = place_of(at.c);
    }
  }

 private:
  static bool same_bits(const Vec3f& a, const Vec3f& b) {
    const auto bits = [](float v) { return std::bit_cast<std::uint32_t>(v); };
    return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
  }
  std::uint8_t place_of(const Vec3f& corner) {
    std::uint32_t place = 0;
    while (place < count && !same_bits(corners[place], corner)) ++place;
    if (place == count) corners[count++] = corner;
    return static_cast<std::uint8_t>(place);
  }
};

void write_indexed(std::byte* block, const BlockCorners& corners, const Distinct& distinct) {
  LeafBound bound = leaf_bound(std::span(corners.stored).first(corners.lanes));
  bound.word = distinct.count << 8;
  std::memcpy(block, &bound, sizeof bound);
  auto* rows = const_cast<float*>(distinct_row(block, corners.lanes, 0));
  for (std::uint32_t i = 0; i < distinct.count; ++i)
    for (int axis = 0; axis < 3; ++axis)
      rows[static_cast<std::uint32_t>(axis) * distinct.count + i] = distinct.corners[i][axis];
  auto* bytes = const_cast<std::uint8_t*>(index_row(block, corners.lanes, 0));
  for (const auto& row : distinct.index) bytes = std::copy_n(row.begin(), corners.lanes, bytes);
}

// --- Rounded blocks ---

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

  explicit Grid(const BlockCorners& corners) {
    Aabb box;
    for (std::uint32_t i = 0; i < corners.lanes; ++i)
      for (const Vec3d& corner :
           {corners.in_frame[i].a, corners.in_frame[i].b, corners.in_frame[i].c})
        box.extend(corner);
    const double farthest = std::max(norm_max(box.lo), norm_max(box.hi));
    exponent =
        exponent_above(std::max({norm_max(box.extent()) / 65534.0, farthest * 0x1p-23, 0x1p-120}));
    for (int axis = 0; axis < 3; ++axis) origin[axis] = std::floor(box.lo[axis] / step()) * step();
  }
  double step() const { return std::ldexp(1.0, exponent); }
  std::uint16_t number(double v, int axis) const {
    return static_cast<std::uint16_t>(std::nearbyint((v - origin[axis]) / step()));
  }
};

std::uint16_t* rounded_rows(std::byte* block, std::uint32_t lanes) {
  return const_cast<std::uint16_t*>(rounded_row(block, lanes, 0));
}

void write_numbers(std::byte* block, const BlockCorners& corners, const Grid& grid) {
  std::uint16_t* rows = rounded_rows(block, corners.lanes);
  for (std::uint32_t lane = 0; lane < corners.lanes; ++lane) {
    const TriangleVertices& at = corners.in_frame[lane];
    std::uint32_t row = 0;
    for (const Vec3d* corner : {&at.a, &at.b, &at.c})
      for (int axis = 0; axis < 3; ++axis)
        rows[row++ * corners.lanes + lane] = grid.number((*corner)[axis], axis);
  }
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

void write_rounded(std::byte* block, const BlockCorners& corners) {
  RoundedHead head{{}, kInfiniteStep};
  if (!corners.all_triangles) {
    std::memcpy(block, &head, sizeof head);
    std::fill_n(rounded_rows(block, corners.lanes), 9 * corners.lanes, std::uint16_t{0});
    return;
  }
  const Grid grid(corners);
  for (int axis = 0; axis < 3; ++axis) head.origin[axis] = static_cast<float>(grid.origin[axis]);
  head.word = static_cast<std::uint32_t>(127 + grid.exponent);
  std::memcpy(block, &head, sizeof head);
  write_numbers(block, corners, grid);
  const double error = kCompactError * grid.step();
  head.word |= upper_bits(1.0001 * longest_edge(block, corners.lanes) + 2 * error);
  std::memcpy(block, &head, sizeof head);
}

}  // namespace

TriangleVertices compact_corners(const std::byte* leaf, std::uint32_t lanes, std::uint32_t lane) {
  double v[9];
  for (std::uint32_t row = 0; row < 9; ++row) {
    const std::uint32_t axis = row % 3;
    if (is_rounded(leaf))
      v[row] = static_cast<double>(rounded_head(leaf).origin[axis]) +
               static_cast<double>(rounded_head(leaf).step()) * rounded_row(leaf, lanes, row)[lane];
    else
      v[row] = static_cast<double>(
          distinct_row(leaf, lanes, axis)[index_row(leaf, lanes, row / 3)[lane]]);
  }
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, {v[6], v[7], v[8]}};
}

BlockSizes compact_sizes(const BlockCorners& corners) {
  const Distinct distinct(corners);
  constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max() / 2;
  return {distinct.count <= kMostDistinct ? indexed_bytes(corners.lanes, distinct.count) : kNever,
          rounded_bytes(corners.lanes)};
}

std::size_t compact_bytes(const std::byte* leaf, std::uint32_t lanes) {
  return is_rounded(leaf) ? rounded_bytes(lanes) : indexed_bytes(lanes, distinct_of(leaf));
}

bool write_compact_block(std::byte* block, const BlockCorners& corners, std::size_t bytes) {
  const Distinct distinct(corners);
  if (distinct.count <= kMostDistinct && indexed_bytes(corners.lanes, distinct.count) <= bytes)
    write_indexed(block, corners, distinct);
  else if (rounded_bytes(corners.lanes) <= bytes)
    write_rounded(block, corners);
  else
    return false;
  return true;
}

}  // namespace strahl
