// query/scene_visitor.h - how structures over all primitives of a scene get to their hits.
//
// Instances: the ray is transformed once per instance and ray (the last one is kept), direction not
// renormalised, so t keeps its meaning; components below 2^-240 become 0, and a transformed ray out
// of range hits nothing there.
// Thread safety: one visitor per thread; begin_ray() before each ray.
#pragma once

#include <optional>

#include <strahl/query/reference_test.h>

namespace strahl {

/// The ray in the object space of an instance; empty when it cannot be represented there.
std::optional<Ray> to_object_space(const Ray& ray, const Affine& to_object);

/// The same, prepared for the instance's object; empty for an instance that cannot be hit.
std::optional<PreparedRay> enter_instance(const Scene& scene, std::uint32_t instance,
                                          const PreparedRay& world_ray);

/// Visits references of one scene. The scene must outlive it.
class SceneVisitor {
 public:
  explicit SceneVisitor(const Scene& scene) : scene_(scene) {}

  const Scene& scene() const { return scene_; }
  void begin_ray() { cached_instance_ = kNoId; }

  /// Whether every crossing counts for the query that lies within its interval.
  template <Query Q>
  bool sees_all(const Q& query) const {
    return query.filter.accepts_all() && !scene_.has_hidden_geometry();
  }
  /// The hit of a reference, but for t and side.
  Hit blank_hit(std::uint32_t reference) const {
    return {0.0, scene_.id_of(reference), false, reference};
  }

  /// Tests the reference against the world ray and offers what is hit. True stops the traversal.
  template <Query Q, class C>
  bool visit(std::uint32_t reference, const PreparedRay& world_ray, Q& query, C& counters) {
    const Part& part = scene_.part_of(reference);
    if (!is_visible(scene_, part, query)) return false;
    const PreparedRay* ray = &world_ray;
    if (!scene_.is_identity(part.instance)) {
      if (cached_instance_ != part.instance) {
        cached_instance_ = part.instance;
        object_ray_ = enter_instance(scene_, part.instance, world_ray);
      }
      if (!object_ray_) return false;
      ray = &*object_ray_;
    }
    return test_reference(scene_, part, reference, *ray, query, counters);
  }

 private:
  const Scene& scene_;
  std::uint32_t cached_instance_ = kNoId;
  std::optional<PreparedRay> object_ray_;
};

}  // namespace strahl
