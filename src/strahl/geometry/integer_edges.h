// geometry/integer_edges.h - signs of edges by integers of 128 bits, where that is exact.
//
// Rays through vertices and along edges make edge values that are zero, which no filter can tell:
//   they are common where rays are aimed at a mesh's own vertices. Coordinates of floats, and
//   doubles of few digits, are multiples of one unit not much smaller than the largest of them; as
//   integers the rule of triangle.h needs a few multiplications instead of expansions.
// Ranges: org and corners are below 2^40 units, so P and Q below 2^41 and n = P x Q below 2^83; dir
// is
//   below 2^40 units of its own, so dir . n is below 3 * 2^123.
// Thread safety: values.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>

#include <strahl/geometry/mesh.h>
#include <strahl/math/vec3.h>

namespace strahl {

class IntegerEdges {
 public:
  /// Empty where a coordinate is no multiple of the unit. All must be finite and 0 or of magnitude
  /// 2^-240..2^240.
  static std::optional<IntegerEdges> make(const Vec3d& org, const Vec3d& dir,
                                          const TriangleVertices& tri) {
    const double unit =
        units_per_one(std::max({norm_max(org), norm_max(tri.a), norm_max(tri.b), norm_max(tri.c)}));
    const double dir_unit = units_per_one(norm_max(dir));
    bool fits = true;
    IntegerEdges edges;
    const Int3 o = integers(org, unit, fits);
    edges.dir_ = integers(dir, dir_unit, fits);
    edges.a_ = minus(integers(tri.a, unit, fits), o);
    edges.b_ = minus(integers(tri.b, unit, fits), o);
    edges.c_ = minus(integers(tri.c, unit, fits), o);
    if (!fits) return std::nullopt;
    return edges;
  }

  /// Signs of the directed edges; 0 where dir . n and n are: the origin is on the edge's line.
  int ab() const { return sign(a_, b_); }
  int bc() const { return sign(b_, c_); }
  int ca() const { return sign(c_, a_); }

 private:
  __extension__ using Wide = __int128;
  struct Int3 {
    std::int64_t x, y, z;
  };
  static constexpr int kBits = 40;

  /// A power of two that brings `largest` just below 2^kBits.
  static double units_per_one(double largest) {
    constexpr std::uint64_t kBias = 1023;
    const std::uint64_t exponent = std::bit_cast<std::uint64_t>(largest) >> 52;
    return std::bit_cast<double>((kBias + kBits - 1 + kBias - exponent) << 52);
  }
  /// Sums with kShift end at the units: its own bits make them integers.
  static std::int64_t integer(double scaled, bool& fits) {
    constexpr double kShift = 0x1.8p52;
    const double shifted = scaled + kShift;
    fits &= shifted - kShift == scaled;
    return std::bit_cast<std::int64_t>(shifted) - std::bit_cast<std::int64_t>(kShift);
  }
  static Int3 integers(const Vec3d& v, double unit, bool& fits) {
    return {integer(v.x * unit, fits), integer(v.y * unit, fits), integer(v.z * unit, fits)};
  }
  static Int3 minus(const Int3& a, const Int3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  static Wide difference(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
    return Wide{a} * b - Wide{c} * d;
  }
  static int sign(Wide v) { return (v > 0) - (v < 0); }

  int sign(const Int3& p, const Int3& q) const {
    const Wide x = difference(p.y, q.z, p.z, q.y), y = difference(p.z, q.x, p.x, q.z),
               z = difference(p.x, q.y, p.y, q.x);
    const Wide along = x * dir_.x + y * dir_.y + z * dir_.z;
    // The first that is not 0, without a branch: signs are as good as random.
    return sign(8 * sign(along) + 4 * sign(x) + 2 * sign(y) + sign(z));
  }

  Int3 dir_, a_, b_, c_;
};

}  // namespace strahl
