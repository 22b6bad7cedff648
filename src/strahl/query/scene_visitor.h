// query/scene_visitor.h - tests one reference of a scene against a ray: the only way to a hit.
//
// All structures end here, so all of them return the same bits. Instances: the ray is transformed
// once per instance and ray (the last one is kept), direction not renormalised, so t keeps its
// meaning; components below 2^-240 become 0, and a transformed ray out of range hits nothing there.
// Thread safety: one visitor per thread; begin_ray() before each ray.
#pragma once

#include <optional>

#include <strahl/geometry/triangle.h>
#include <strahl/query/counters.h>
#include <strahl/query/policies.h>

namespace strahl {

/// The ray in the object space of an instance; empty when it cannot be represented there.
std::optional<Ray> to_object_space(const Ray& ray, const Affine& to_object);

/// Visits references of one scene. The scene must outlive it.
class SceneVisitor {
 public:
  explicit SceneVisitor(const Scene& scene) : scene_(scene) {}

  void begin_ray() { cached_instance_ = kNoId; }

  /// Tests the reference against the world ray and offers what is hit. True stops the traversal.
  template <Query Q, class C>
  bool visit(std::uint32_t reference, const PreparedRay& world_ray, Q& query, C& counters) {
    const Part& part = scene_.part_of(reference);
    const Geometry& geometry = scene_.geometries()[part.geometry];
    if ((geometry.mask & query.mask()) == 0) return false;
    const PreparedRay* ray = &world_ray;
    if (!scene_.is_identity(part.instance)) {
      if (cached_instance_ != part.instance) enter_instance(part.instance, world_ray);
      if (!object_ray_) return false;
      ray = &*object_ray_;
    }
    counters.primitive_tested();
    const std::uint32_t prim = reference - part.first_reference;
    const Hit blank{0.0,
                    {scene_.instances()[part.instance].instance_id, geometry.geometry_id, prim},
                    false,
                    reference};
    if (geometry.kind == PrimitiveKind::triangle)
      return visit_triangle(geometry.mesh[prim], *ray, blank, query);
    const CurvedHits hits = geometry.kind == PrimitiveKind::sphere
                                ? curved_hits(geometry.spheres[prim], *ray)
                                : curved_hits(geometry.cones[prim], *ray);
    return offer_all(hits, blank, query);
  }

 private:
  template <Query Q>
  static bool visit_triangle(const TriangleVertices& tri, const PreparedRay& ray, Hit hit,
                             Q& query) {
    if constexpr (Q::kTestsOrigin)
      if (is_on_triangle(ray.org, tri)) return query.origin_on_surface();
    const std::optional<TriangleHit> crossing = intersect(ray, tri);
    if (!crossing) return false;
    hit.t = crossing->t, hit.is_front = crossing->is_front;
    return query.offer(hit);
  }
  template <class Curved>
  static CurvedHits curved_hits(const Curved& primitive, const PreparedRay& ray) {
    const CurvedHits hits = intersect(primitive, ray.org, ray.dir);
    if (hits.count == 0) return hits;
    return tie_to_box(hits, ray.org, ray.dir, bounds(primitive));
  }
  template <Query Q>
  static bool offer_all(const CurvedHits& hits, Hit hit, Q& query) {
    for (int i = 0; i < hits.count; ++i) {
      const CurvedHit& root = hits.hit[static_cast<std::size_t>(i)];
      hit.t = root.t, hit.is_front = root.is_front;
      if (query.offer(hit)) return true;
    }
    return false;
  }
  void enter_instance(std::uint32_t instance, const PreparedRay& world_ray);

  const Scene& scene_;
  std::uint32_t cached_instance_ = kNoId;
  std::optional<PreparedRay> object_ray_;
};

}  // namespace strahl
