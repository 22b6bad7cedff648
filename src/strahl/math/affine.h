// math/affine.h - affine maps of space, applied and composed by fixed formulas.
#pragma once

#include <array>

#include <strahl/math/aabb.h>

namespace strahl {

/// Row-major 3x4 matrix: x' = row0.xyz . x + row0.w, and so on.
struct Affine {
  std::array<std::array<double, 4>, 3> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  /// Row i = ((m0*x + m1*y) + m2*z) + m3; the order of operations is part of the contract.
  constexpr Vec3d point(const Vec3d& p) const {
    return {row(0, p) + m[0][3], row(1, p) + m[1][3], row(2, p) + m[2][3]};
  }
  /// The same without the translation; directions are not renormalised.
  constexpr Vec3d vector(const Vec3d& v) const { return {row(0, v), row(1, v), row(2, v)}; }
  /// Transposed linear part times v: maps normals when *this is the inverse map.
  constexpr Vec3d transposed_vector(const Vec3d& v) const {
    return {(m[0][0] * v.x + m[1][0] * v.y) + m[2][0] * v.z,
            (m[0][1] * v.x + m[1][1] * v.y) + m[2][1] * v.z,
            (m[0][2] * v.x + m[1][2] * v.y) + m[2][2] * v.z};
  }
  constexpr bool operator==(const Affine&) const = default;
  constexpr bool is_identity() const { return *this == Affine{}; }

  static constexpr Affine translation(const Vec3d& t) {
    Affine a;
    a.m[0][3] = t.x, a.m[1][3] = t.y, a.m[2][3] = t.z;
    return a;
  }
  static constexpr Affine scaling(const Vec3d& s) {
    Affine a;
    a.m[0][0] = s.x, a.m[1][1] = s.y, a.m[2][2] = s.z;
    return a;
  }
  /// Rotation by a quaternion (x, y, z, w) used as given: normalise first.
  static Affine rotation(double x, double y, double z, double w);

 private:
  constexpr double row(int i, const Vec3d& p) const {
    const auto& r = m[static_cast<std::size_t>(i)];
    return (r[0] * p.x + r[1] * p.y) + r[2] * p.z;
  }
};

/// The map that applies b first, then a.
Affine operator*(const Affine& a, const Affine& b);

/// Box around the images of the eight corners. It holds the rounded image of every point of the
/// box, as each row is monotone in each coordinate and rounding is, too.
Aabb transformed(const Affine& map, const Aabb& box);

/// Determinant of the linear part.
double determinant(const Affine& a);

/// Inverse by the adjugate in double; meaningless where is_well_conditioned() is false.
Affine inverse(const Affine& a);

/// Largest row sum of magnitudes of the linear part.
double norm_rows(const Affine& a);

/// At least the largest factor by which the linear part stretches a length.
double longest_stretch(const Affine& a);

/// True when all entries are finite and the condition number of the linear part (row-sum norm
/// times that of the inverse) is at most 2^30.
bool is_well_conditioned(const Affine& a);

}  // namespace strahl
