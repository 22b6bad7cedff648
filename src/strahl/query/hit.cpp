#include <strahl/base/fp_env.h>
#include <strahl/geometry/triangle.h>
#include <strahl/query/hit.h>
#include <strahl/query/scene_visitor.h>

namespace strahl {
namespace {

HitSurface object_surface(const Geometry& geometry, std::uint32_t prim, const Ray& ray, double t) {
  HitSurface surface;
  surface.face_id = geometry.face_ids.empty() ? prim : geometry.face_ids[prim];
  if (geometry.kind == PrimitiveKind::sphere) {
    surface.normal = normal_at(geometry.spheres[prim], ray.org, ray.dir, t);
  } else if (geometry.kind == PrimitiveKind::cone) {
    surface.normal = normal_at(geometry.cones[prim], ray.org, ray.dir, t);
  } else {
    const TriangleSurface s = surface_at(ray.org, ray.dir, geometry.mesh[prim]);
    surface.u = s.u, surface.v = s.v, surface.normal = s.normal;
  }
  return surface;
}

}  // namespace

HitSurface surface_at(const Scene& scene, const Ray& ray, const Hit& hit) {
  if (!hit.is_hit()) return {};
  const FpEnvGuard environment;
  const Part& part = scene.part_of(hit.reference);
  const Geometry& geometry = scene.geometries()[part.geometry];
  const std::uint32_t prim = hit.reference - part.first_reference;
  if (scene.is_identity(part.instance)) return object_surface(geometry, prim, ray, hit.t);
  const Affine& to_object = scene.to_object()[part.instance];
  HitSurface surface = object_surface(geometry, prim, *to_object_space(ray, to_object), hit.t);
  surface.normal = unit(to_object.transposed_vector(surface.normal)) + Vec3d{};  // no -0
  return surface;
}

}  // namespace strahl
