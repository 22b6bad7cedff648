#include <algorithm>
#include <cmath>
#include <utility>

#include <strahl/geometry/cone.h>
#include <strahl/geometry/instance_source.h>
#include <strahl/geometry/mesh.h>
#include <strahl/geometry/outline.h>
#include <strahl/geometry/scene.h>
#include <strahl/geometry/sphere.h>

namespace strahl {
namespace {

/// What roundings may add to a cylinder and to any other cone, in units of its largest extent.
constexpr double kCylinderSlack = 0x1p-30, kConeSlack = 0x1p-6;

}  // namespace

Outline outline_of(const TriangleVertices& tri, const Affine& map) {
  Outline out;
  out.count = 3;
  out.ball[0].center = map.point(tri.a);
  out.ball[1].center = map.point(tri.b);
  out.ball[2].center = map.point(tri.c);
  if (determinant(map) < 0.0) std::swap(out.ball[1], out.ball[2]);
  return out;
}

Outline outline_of(const Sphere& sphere) {
  Outline out;
  out.count = 1;
  out.ball[0] = {sphere.center, sphere.radius};
  return out;
}

Outline outline_of(const Cone& cone) {
  Outline out;
  out.cone = &cone;
  const Vec3d axis = cone.apex - cone.base;
  const double unit = std::max({norm_max(axis), cone.base_radius, cone.apex_radius});
  const double height = length(axis / unit);
  const double wide = std::max(cone.base_radius, cone.apex_radius) / unit;
  const double widening = (cone.apex_radius - cone.base_radius) / unit;
  if (std::abs(widening) > 1.7 * height) {  // flatter than 60 degrees
    out.count = 1;
    const double reach = std::sqrt(0.25 * height * height + wide * wide);
    out.ball[0] = {0.5 * cone.base + 0.5 * cone.apex, 1.001 * reach * unit};
    return out;
  }
  const double slack = (widening == 0.0 ? kCylinderSlack : kConeSlack) * unit;
  out.count = 2;
  out.ball[0] = {cone.base, cone.base_radius + slack};
  out.ball[1] = {cone.apex, cone.apex_radius + slack};
  return out;
}

Outline outline_of(const Aabb& box, const Affine& map) {
  Outline out;
  out.count = 8;
  for (std::size_t i = 0; i < 8; ++i)
    out.ball[i].center = map.point(
        {(i & 1 ? box.hi : box.lo).x, (i & 2 ? box.hi : box.lo).y, (i & 4 ? box.hi : box.lo).z});
  return out;
}

Outline PrimitiveSource::outline(std::uint32_t) const { return {}; }

Outline Scene::object_outline(std::uint32_t reference) const {
  const Part& part = part_of(reference);
  const Geometry& g = geometries_[part.geometry];
  const std::uint32_t prim = reference - part.first_reference;
  if (g.kind == PrimitiveKind::triangle) return outline_of(g.mesh[prim], {});
  return g.kind == PrimitiveKind::sphere ? outline_of(g.spheres[prim]) : outline_of(g.cones[prim]);
}

Outline Scene::outline(std::uint32_t reference) const {
  const Part& part = part_of(reference);
  if (is_identity_[part.instance]) return object_outline(reference);
  const Geometry& g = geometries_[part.geometry];
  const Affine& map = instances_[part.instance].to_world;
  if (g.kind != PrimitiveKind::triangle) return outline_of(object_bounds(reference), map);
  return outline_of(g.mesh[reference - part.first_reference], map);
}

Outline ObjectSource::outline(std::uint32_t i) const { return scene_.object_outline(reference(i)); }

}  // namespace strahl
