#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <strahl/bounds/fit.h>
#include <strahl/geometry/cone.h>
#include <strahl/geometry/outline.h>
#include <strahl/math/expansion.h>
#include <strahl/structures/bvh/bvh_check.h>

namespace strahl {
namespace {

/// Computed points of curved surfaces are drawn in by this part of a radius, to be surely on them.
constexpr double kDrawnIn = 1.0 - 0x1p-40;

void add_rim(const Vec3d& center, double radius, const Basis& basis, std::vector<Vec3d>& out) {
  constexpr int kPoints = 16;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPoints, r = kDrawnIn * radius;
    out.push_back(center + (r * std::cos(angle)) * basis.u + (r * std::sin(angle)) * basis.v);
  }
}

/// i/8 a + j/8 b + k/8 c, if each coordinate is exact: then it lies in the triangle for sure.
std::optional<Vec3d> exact_mix(const Outline& triangle, const std::array<int, 3>& eighths) {
  Vec3d point;
  for (int axis = 0; axis < 3; ++axis) {
    TwoTerms sum{0.0, 0.0};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const double x = triangle.ball[corner].center[axis], weight = 0.125 * eighths[corner];
      const double part = x * weight;
      sum = two_sum(sum.high, part);
      if (sum.low != 0.0 || std::fma(x, weight, -part) != 0.0) return std::nullopt;
    }
    point[axis] = sum.high;
  }
  return point;
}

void add_lattice(const Outline& triangle, std::vector<Vec3d>& out) {
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; i + j <= 8; ++j)
      if (const std::optional<Vec3d> p = exact_mix(triangle, {i, j, 8 - i - j})) out.push_back(*p);
}

void add_lattice(const Aabb& box, std::vector<Vec3d>& out) {
  constexpr int kSteps = 4;
  const auto at = [&](int axis, int step) {
    const double part = static_cast<double>(step) / kSteps;
    const double x = (1 - part) * box.lo[axis] + part * box.hi[axis];
    return std::clamp(x, box.lo[axis], box.hi[axis]);
  };
  for (int x = 0; x <= kSteps; ++x)
    for (int y = 0; y <= kSteps; ++y)
      for (int z = 0; z <= kSteps; ++z) out.push_back({at(0, x), at(1, y), at(2, z)});
}

}  // namespace

std::vector<Vec3d> covering_points(const PrimitiveSource& source, std::uint32_t i) {
  std::vector<Vec3d> points = defining_points(source, i);
  const Outline outline = source.outline(i);
  if (outline.is_triangle())
    add_lattice(outline, points);
  else if (!outline.is_sphere() && outline.cone == nullptr)
    add_lattice(source.bounds(i), points);
  return points;
}

std::vector<Vec3d> defining_points(const PrimitiveSource& source, std::uint32_t i) {
  const Outline outline = source.outline(i);
  std::vector<Vec3d> points;
  if (outline.is_triangle()) {
    for (const Ball& corner : outline.balls()) points.push_back(corner.center);
  } else if (outline.is_sphere()) {
    const auto& [center, radius] = outline.ball[0];
    for (const Vec3d& n : dop_directions())
      for (const double side : {-kDrawnIn, kDrawnIn}) points.push_back(center + side * radius * n);
  } else if (outline.cone != nullptr) {
    const Cone& cone = *outline.cone;
    const Basis basis(cone.apex - cone.base);
    add_rim(cone.base, cone.base_radius, basis, points);
    add_rim(cone.apex, cone.apex_radius, basis, points);
  } else {
    EnclosedSet corners;
    corners.add(source.bounds(i));
    points.assign(corners.points().begin(), corners.points().end());
  }
  return points;
}

}  // namespace strahl
