// query/instance_visitor.h - how a structure over the instances of a scene gets to its hits: each
// instance asks the structure of its object, in object space.
//
// With it any structure over geometry/instance_source.h becomes the top of a two-level structure
// over structures of any kind, and the hits have the bits of a flat structure: the ray is
// transformed by the same matrix and ends in the same test. In object space nothing is widened, as
// there the transformed ray is the very ray of the exact test.
// Thread safety: one visitor per thread.
#pragma once

#include <optional>
#include <span>

#include <strahl/query/scene_visitor.h>

namespace strahl {

/// Visits the primitives of one instance by their number in its object; remembers a stop.
class ObjectVisitor {
 public:
  ObjectVisitor(const Scene& scene, std::uint32_t instance)
      : scene_(scene), first_reference_(scene.first_reference(instance)) {}
  /// For the primitives of another from number `first` on, which become 0, 1, ...
  ObjectVisitor(const ObjectVisitor& whole, std::uint32_t first)
      : scene_(whole.scene_), first_reference_(whole.first_reference_ + first) {}

  template <Query Q, class C>
  bool visit(std::uint32_t number, const PreparedRay& object_ray, Q& query, C& counters) {
    const std::uint32_t reference = first_reference_ + number;
    const Part& part = scene_.part_of(reference);
    if (!is_visible(scene_, part, query)) return false;
    has_stopped_ = test_reference(scene_, part, reference, object_ray, query, counters);
    return has_stopped_;
  }
  bool has_stopped() const { return has_stopped_; }
  /// Takes over the end of a traversal of some of its primitives; returns whether it was stopped.
  bool end_run(const ObjectVisitor& run) { return has_stopped_ = run.has_stopped_; }

  template <Query Q>
  bool sees_all(const Q& query) const {
    return query.filter.accepts_all() && !scene_.has_hidden_geometry();
  }
  Hit blank_hit(std::uint32_t number) const {
    const std::uint32_t reference = first_reference_ + number;
    return {0.0, scene_.id_of(reference), false, reference};
  }

 private:
  const Scene& scene_;
  std::uint32_t first_reference_;
  bool has_stopped_ = false;
};

/// Visits instances of one scene. Bottom has trace(visitor, ray, query, counters) over the numbers
/// of an ObjectSource. Scene and bottoms must outlive it.
template <class Bottom>
class InstanceVisitor {
 public:
  /// @param bottom_of the structure of each instance's object, shape (instances)
  InstanceVisitor(const Scene& scene, std::span<const Bottom* const> bottom_of)
      : scene_(scene), bottom_of_(bottom_of) {}

  /// Offers every hit with the instance that the query may want. True stops the traversal.
  template <Query Q, class C>
  bool visit(std::uint32_t instance, const PreparedRay& world_ray, Q& query, C& counters) {
    const PreparedRay* ray = &world_ray;
    std::optional<PreparedRay> object_ray;
    if (!scene_.is_identity(instance)) {
      object_ray = enter_instance(scene_, instance, world_ray);
      if (!object_ray) return false;
      ray = &*object_ray;
    }
    ObjectVisitor prims(scene_, instance);
    bottom_of_[instance]->trace(prims, *ray, query, counters);
    return prims.has_stopped();
  }

 private:
  const Scene& scene_;
  std::span<const Bottom* const> bottom_of_;
};

}  // namespace strahl
