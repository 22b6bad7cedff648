#include <algorithm>
#include <cmath>

#include <strahl/render/look.h>

namespace strahl {
namespace {

Vec3d mix(const Vec3d& a, const Vec3d& b, double share) { return a + share * (b - a); }

Vec3d times(const Vec3d& a, const Vec3d& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

}  // namespace

const Material& material_of(const Scene& scene, const Hit& hit) {
  static constexpr Material kPlain;
  const Geometry& geometry = scene.geometries()[scene.part_of(hit.reference).geometry];
  const std::vector<Material>& materials = scene.data().materials;
  const std::size_t index =
      hit.id.prim < geometry.materials.size() ? geometry.materials[hit.id.prim] : 0;
  return index < materials.size() ? materials[index] : kPlain;
}

SurfacePoint surface_point(const Scene& scene, const Ray& ray, const Hit& hit) {
  const Vec3d normal = surface_at(scene, ray, hit).normal;
  return {ray.org + hit.t * ray.dir, dot(normal, ray.dir) > 0.0 ? -normal : normal,
          material_of(scene, hit).color};
}

Look::Look(const Scene& scene, const Camera& camera, const Vec3d& up)
    : scene_(scene),
      up_(normalized(up)),
      key_(normalized(0.8 * camera.up() - 0.65 * camera.right() - 0.6 * camera.forward())) {}

Vec3d Look::background(const Vec3d& dir) const {
  if (scene_.data().background) return *scene_.data().background;
  const double height = dot(normalized(dir), up_);
  return mix({0.62, 0.65, 0.69}, {0.22, 0.28, 0.36}, std::clamp(0.5 + 0.8 * height, 0.0, 1.0));
}

Vec3d Look::sky(const Vec3d& dir) const {
  const Vec3d unit = normalized(dir);
  const double height = dot(unit, up_);
  const Vec3d dome = height > 0.0 ? mix({0.62, 0.62, 0.62}, {0.36, 0.46, 0.62}, std::sqrt(height))
                                  : mix({0.36, 0.35, 0.34}, {0.14, 0.13, 0.12}, -height);
  const double glow = std::pow(std::max(0.0, dot(unit, key_)), 8.0);
  return dome + glow * Vec3d{1.7, 1.55, 1.35};
}

Vec3d Look::shade(const SurfacePoint& point, const Vec3d& dir, double open) const {
  const double head = -dot(point.normal, normalized(dir));
  const double key = std::max(0.0, dot(point.normal, key_));
  const double above = 0.5 + 0.5 * dot(point.normal, up_);
  const Vec3d around = mix({0.20, 0.18, 0.17}, {0.30, 0.34, 0.40}, above) * open;
  const Vec3d lamps =
      (0.35 + 0.65 * open) * (0.18 * head * Vec3d{1, 1, 1} + 0.52 * key * Vec3d{1.0, 0.96, 0.88});
  return times(point.color, around + lamps);
}

}  // namespace strahl
