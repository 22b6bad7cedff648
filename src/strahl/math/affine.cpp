#include <algorithm>
#include <cmath>

#include <strahl/math/affine.h>

namespace strahl {
namespace {

double minor2(const Affine& a, std::size_t r0, std::size_t r1, std::size_t c0, std::size_t c1) {
  return a.m[r0][c0] * a.m[r1][c1] - a.m[r0][c1] * a.m[r1][c0];
}

}  // namespace

Affine Affine::rotation(double x, double y, double z, double w) {
  Affine a;
  a.m[0] = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0};
  a.m[1] = {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0};
  a.m[2] = {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0};
  return a;
}

Affine operator*(const Affine& a, const Affine& b) {
  Affine r;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      r.m[i][j] = (a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j]) + a.m[i][2] * b.m[2][j];
      if (j == 3) r.m[i][j] += a.m[i][3];
    }
  return r;
}

Aabb transformed(const Affine& map, const Aabb& box) {
  Aabb image;
  for (int corner = 0; corner < 8; ++corner)
    image.extend(map.point({corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                            corner & 4 ? box.hi.z : box.lo.z}));
  return image;
}

double determinant(const Affine& a) {
  return (a.m[0][0] * minor2(a, 1, 2, 1, 2) - a.m[0][1] * minor2(a, 1, 2, 0, 2)) +
         a.m[0][2] * minor2(a, 1, 2, 0, 1);
}

Affine inverse(const Affine& a) {
  if (a.is_identity()) return a;
  const double inv_det = 1.0 / determinant(a);
  Affine r;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      // Cofactor of (j, i) with cyclic indices carries its sign.
      const std::size_t r0 = (j + 1) % 3, r1 = (j + 2) % 3, c0 = (i + 1) % 3, c1 = (i + 2) % 3;
      r.m[i][j] = minor2(a, r0, r1, c0, c1) * inv_det;
    }
  const Vec3d t = r.vector({a.m[0][3], a.m[1][3], a.m[2][3]});
  r.m[0][3] = -t.x, r.m[1][3] = -t.y, r.m[2][3] = -t.z;
  return r;
}

double norm_rows(const Affine& a) {
  double norm = 0;
  for (const auto& r : a.m) norm = std::max(norm, std::abs(r[0]) + std::abs(r[1]) + std::abs(r[2]));
  return norm;
}

double longest_stretch(const Affine& a) {
  double columns = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    columns = std::max(columns, std::abs(a.m[0][c]) + std::abs(a.m[1][c]) + std::abs(a.m[2][c]));
  return std::sqrt(norm_rows(a) * columns);
}

bool is_well_conditioned(const Affine& a) {
  for (const auto& r : a.m)
    for (double v : r)
      if (!std::isfinite(v)) return false;
  // Scale first so that the determinant of a tiny or huge but well-shaped map stays in range.
  const double scale = norm_rows(a);
  if (!(scale > 0x1p-200 && scale < 0x1p200)) return false;
  Affine unit = a;
  for (auto& r : unit.m)
    for (std::size_t j = 0; j < 3; ++j) r[j] /= scale;
  const Affine back = inverse(unit);
  // A singular map's inverse holds NaN, which a maximum would pass over.
  for (const auto& r : back.m)
    for (std::size_t j = 0; j < 3; ++j)
      if (!std::isfinite(r[j])) return false;
  return norm_rows(unit) * norm_rows(back) <= 0x1p30;
}

}  // namespace strahl
