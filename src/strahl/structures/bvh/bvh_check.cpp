#include <cmath>
#include <numbers>

#include <strahl/bounds/fit.h>
#include <strahl/geometry/cone.h>
#include <strahl/geometry/outline.h>
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

}  // namespace

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
