// geometry/instance_source.h - a scene as two sets to build over: its instances, and the primitives
// of each object in object space.
//
// An object is a run of geometries that one or more instances place; its structure is built once
// and shared. Things of an object are numbered as the references of any of its instances, from 0.
// Thread safety: immutable; the scene must outlive the sources.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <strahl/geometry/scene.h>

namespace strahl {

/// The primitives that an instance places, in object space.
class ObjectSource final : public PrimitiveSource {
 public:
  ObjectSource(const Scene& scene, std::uint32_t instance) : scene_(scene), instance_(instance) {}

  std::uint32_t size() const override { return scene_.reference_count(instance_); }
  Aabb bounds(std::uint32_t i) const override { return scene_.object_bounds(reference(i)); }
  Aabb clip(std::uint32_t i, const Aabb& box) const override {
    return scene_.object_clip(reference(i), box);
  }
  Outline outline(std::uint32_t i) const override;
  bool triangle(std::uint32_t i, TriangleVertices& vertices) const override {
    return scene_.object_triangle(reference(i), vertices);
  }

 private:
  std::uint32_t reference(std::uint32_t i) const { return scene_.first_reference(instance_) + i; }

  const Scene& scene_;
  std::uint32_t instance_;
};

/// The instances of a scene with world boxes around all they place; one without anything that can
/// be hit has an empty box.
class InstanceSource final : public PrimitiveSource {
 public:
  /// O(instances * log objects).
  explicit InstanceSource(const Scene& scene);
  /// Of a pose of the scene that `other` is of. O(1).
  InstanceSource(const Scene& pose, const InstanceSource& other)
      : scene_(&pose), grouping_(other.grouping_) {}

  std::uint32_t size() const override {
    return static_cast<std::uint32_t>(scene_->instances().size());
  }
  Aabb bounds(std::uint32_t instance) const override { return scene_->instance_bounds(instance); }
  Aabb clip(std::uint32_t instance, const Aabb& box) const override {
    return Aabb::intersection(bounds(instance), box);
  }

  const Scene& scene() const { return *scene_; }
  /// An instance of each object, in the order of their first instances.
  const std::vector<std::uint32_t>& objects() const { return grouping_->objects; }
  /// Index into objects().
  std::uint32_t object_of(std::uint32_t instance) const { return grouping_->object_of[instance]; }
  /// Live bytes of its own.
  std::uint64_t bytes() const;

 private:
  /// Shared by all poses.
  struct Grouping {
    std::vector<std::uint32_t> objects, object_of;
  };

  const Scene* scene_;
  std::shared_ptr<const Grouping> grouping_;
};

}  // namespace strahl
