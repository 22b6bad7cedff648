// render/look.h - colours: surfaces, sky and light. Linear, 1 is white.
#pragma once

#include <strahl/query/hit.h>
#include <strahl/render/camera.h>

namespace strahl {

/// Where a ray met a surface, seen from the ray's side.
struct SurfacePoint {
  Vec3d position;
  Vec3d normal;  ///< unit, towards where the ray came from
  Vec3d color;   ///< of the primitive's material
};

/// How the primitive that was hit looks. Requires: hit.is_hit().
const Material& material_of(const Scene& scene, const Hit& hit);

/// Requires: hit.is_hit().
SurfacePoint surface_point(const Scene& scene, const Ray& ray, const Hit& hit);

/// Light and background of a picture.
class Look {
 public:
  Look(const Scene& scene, const Camera& camera, const Vec3d& up);

  /// What a ray that hits nothing shows: the scene's background colour, else a soft gradient.
  Vec3d background(const Vec3d& dir) const;
  /// Light that arrives from outside the scene: bright above, a wide glow around the key light.
  Vec3d sky(const Vec3d& dir) const;
  /// Headlight, key light and surroundings; open is the share of the surroundings not hidden.
  Vec3d shade(const SurfacePoint& point, const Vec3d& dir, double open) const;

 private:
  const Scene& scene_;
  Vec3d up_, key_;
};

}  // namespace strahl
