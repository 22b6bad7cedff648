// query/reference_test.h - tests one reference of a scene against a ray in its object space.
//
// All visitors end here, so all structures return the same bits.
// Thread safety: pure functions besides what they are given.
#pragma once

#include <optional>

#include <strahl/geometry/triangle.h>
#include <strahl/query/counters.h>
#include <strahl/query/policies.h>

namespace strahl {

/// Whether the query sees the geometry of the part at all.
template <Query Q>
bool is_visible(const Scene& scene, const Part& part, const Q& query) {
  return (scene.geometries()[part.geometry].mask & query.mask()) != 0;
}

template <Query Q>
bool offer_triangle(const TriangleVertices& tri, const ExactRay& ray, Hit hit, Q& query) {
  if constexpr (Q::kTestsOrigin)
    if (is_on_triangle(ray.org, tri)) return query.origin_on_surface();
  const std::optional<TriangleHit> crossing = intersect(ray, tri);
  if (!crossing) return false;
  hit.t = crossing->t, hit.is_front = crossing->is_front;
  return query.offer(hit);
}

template <class Curved, Query Q>
bool offer_curved(const Curved& primitive, const PreparedRay& ray, Hit hit, Q& query) {
  CurvedHits hits = intersect(primitive, ray.org, ray.dir);
  if (hits.count > 0) hits = tie_to_box(hits, ray.org, ray.dir, bounds(primitive));
  for (int i = 0; i < hits.count; ++i) {
    const CurvedHit& root = hits.hit[static_cast<std::size_t>(i)];
    hit.t = root.t, hit.is_front = root.is_front;
    if (query.offer(hit)) return true;
  }
  return false;
}

/// Offers the hits of the ray with the reference of that part. True stops the traversal.
template <Query Q, class C>
bool test_reference(const Scene& scene, const Part& part, std::uint32_t reference,
                    const PreparedRay& object_ray, Q& query, C& counters) {
  const Geometry& geometry = scene.geometries()[part.geometry];
  counters.primitive_tested();
  const std::uint32_t prim = reference - part.first_reference;
  const Hit blank{0.0,
                  {scene.instances()[part.instance].instance_id, geometry.geometry_id, prim},
                  false,
                  reference};
  if (geometry.kind == PrimitiveKind::triangle)
    return offer_triangle(geometry.mesh[prim], object_ray, blank, query);
  if (geometry.kind == PrimitiveKind::sphere)
    return offer_curved(geometry.spheres[prim], object_ray, blank, query);
  return offer_curved(geometry.cones[prim], object_ray, blank, query);
}

}  // namespace strahl
