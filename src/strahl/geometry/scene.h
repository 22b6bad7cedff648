// geometry/scene.h - what is to be hit: geometries, instances of them, and their numbering.
//
// SceneData is the plain description that readers and generators fill. Scene is its checked,
// immutable form: refused primitives known, instances inverted, references numbered. A pose of a
// scene is another scene that shares all but the matrices and what follows from them.
// Ids: (instance_id, geometry_id, primitive_id) as DESIGN fixes them per format.
// Thread safety: Scene is immutable; const access from any number of threads.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <strahl/geometry/cone.h>
#include <strahl/geometry/mesh.h>
#include <strahl/geometry/primitive_source.h>
#include <strahl/geometry/sphere.h>
#include <strahl/math/affine.h>

namespace strahl {

/// How a surface looks; only renderers and ray-tree workloads read it.
struct Material {
  Vec3d color{0.8, 0.8, 0.8};
  double diffuse = 1.0, specular = 0.0, shine = 0.0, transmission = 0.0, refraction_index = 1.0;
};

enum class PrimitiveKind : std::uint8_t { triangle, sphere, cone };

/// Primitives of one kind. primitive_id counts them from 0. Exactly the member of `kind` is used.
struct Geometry {
  PrimitiveKind kind = PrimitiveKind::triangle;
  TriangleMesh mesh;
  std::vector<Sphere> spheres;
  std::vector<Cone> cones;
  std::vector<std::uint32_t> face_ids;   ///< source polygon of each primitive; empty: its own id
  std::vector<std::uint32_t> materials;  ///< index per primitive; empty: material 0 for all
  std::uint32_t geometry_id = 0;         ///< reported in hits
  std::uint32_t mask = ~0u;              ///< rays whose mask shares no bit pass through
  std::string name;

  std::size_t size() const {
    return kind == PrimitiveKind::triangle ? mesh.size()
           : kind == PrimitiveKind::sphere ? spheres.size()
                                           : cones.size();
  }
};

/// Geometries [first_geometry, first_geometry + geometry_count) placed in the world.
struct Instance {
  std::uint32_t first_geometry = 0, geometry_count = 0;
  Affine to_world;                ///< composed by the reader, object -> world
  std::uint32_t instance_id = 0;  ///< reported in hits
};

/// A camera as NFF and the standard scenes state it; fov is the full angle in degrees.
struct View {
  Vec3d from, at, up{0, 0, 1};
  double fov_degrees = 45.0;
  int width = 512, height = 512;
};

/// Plain description of a scene, filled by readers and generators.
struct SceneData {
  std::vector<Geometry> geometries;
  std::vector<Instance> instances;  ///< empty: one identity instance of all geometries, id 0
  std::vector<Material> materials;
  std::optional<View> view;
  std::vector<Vec3d> lights;
  std::optional<Vec3d> background;
  std::vector<std::string> warnings;  ///< what a reader skipped or repaired, with its place
  std::string source;                 ///< file name or generator text, for messages
};

/// Names one primitive of the scene.
struct PrimitiveId {
  std::uint32_t inst, geom, prim;
  constexpr auto operator<=>(const PrimitiveId&) const = default;
};

/// One geometry under one instance: a run of consecutive references.
struct Part {
  std::uint32_t instance, geometry;  ///< indices into instances() and geometries()
  std::uint32_t first_reference;     ///< reference i of this part is primitive i - first_reference
};

/// Counts for the scene report.
struct SceneCounts {
  std::uint64_t triangles = 0, spheres = 0, cones = 0;  ///< distinct, not instanced
  std::uint64_t references = 0;                         ///< instanced primitives
  std::uint64_t refused_zero_area = 0, refused_not_finite = 0, refused_repeated_vertex = 0;
  std::uint64_t refused_curved = 0;  ///< invalid spheres and cones
  std::uint64_t refused() const {
    return refused_zero_area + refused_not_finite + refused_repeated_vertex + refused_curved;
  }
};

/// The checked, immutable scene. Copies and poses share geometry and numbering.
class Scene final : public PrimitiveSource {
 public:
  /// Checks and freezes. O(primitives + vertices).
  /// Throws Error{bad_input}: an index out of range, a finite float64 coordinate of magnitude
  ///   outside 2^-240..2^240, a near-singular instance map (condition above 2^30), instance
  ///   ranges out of bounds; Error{resource}: more than 2^32 - 2 instanced primitives.
  explicit Scene(SceneData data);

  /// The same things placed anew, for all queries as if loaded with these maps. O(instances).
  /// @param to_world object -> world, one per instance
  /// Throws Error{usage} when that is not their number, Error{bad_input} as the constructor does
  ///   for instance maps.
  Scene posed(std::span<const Affine> to_world) const;
  /// Whether one is a pose or a copy of the other.
  bool is_pose_of(const Scene& other) const { return content_ == other.content_; }

  /// As given; for where instances are now see instances().
  const SceneData& data() const;
  std::span<const Geometry> geometries() const { return geometries_; }
  const std::vector<Instance>& instances() const { return instances_; }
  const std::vector<Affine>& to_object() const { return to_object_; }  ///< per instance
  const SceneCounts& counts() const;

  /// References: every primitive under every instance, numbered 0..size()-1 in part order, which is
  /// ascending (instance, geometry, primitive) index order.
  std::uint32_t size() const override { return reference_count_; }
  std::span<const Part> parts() const { return parts_; }
  const Part& part_of(std::uint32_t reference) const {
    if (parts_.size() == 1) return parts_.front();
    std::uint32_t p = first_part_of_block_[reference / kBlock];
    while (p + 1 < parts_.size() && parts_[p + 1].first_reference <= reference) ++p;
    return parts_[p];
  }
  PrimitiveId id_of(std::uint32_t reference) const {
    const Part& part = part_of(reference);
    return {instances_[part.instance].instance_id, geometries_[part.geometry].geometry_id,
            reference - part.first_reference};
  }
  /// References of one instance: consecutive, in the order in which its object numbers them.
  std::uint32_t first_reference(std::uint32_t instance) const {
    return first_references_[instance];
  }
  std::uint32_t reference_count(std::uint32_t instance) const {
    return first_references_[instance + 1] - first_references_[instance];
  }

  /// World box of a reference; empty exactly when it can never be hit (refused primitives).
  Aabb bounds(std::uint32_t reference) const override;
  /// Conservative world box of the part of the reference inside box; empty only if that part is.
  Aabb clip(std::uint32_t reference, const Aabb& box) const override;
  Outline outline(std::uint32_t reference) const override;
  bool triangle(std::uint32_t reference, TriangleVertices& vertices) const override;
  void bounds_from(std::uint32_t first, std::span<Aabb> boxes) const override;
  void triangles(std::span<const std::uint32_t> references,
                 TriangleVertices* triangles) const override;
  /// Has the memory that triangles() reads on its way, so that it waits once for many.
  void ask_for_triangles(std::span<const std::uint32_t> references) const;
  bool stores_floats() const override;
  /// The same in the object space of the reference's instance.
  Aabb object_bounds(std::uint32_t reference) const;
  Aabb object_clip(std::uint32_t reference, const Aabb& box) const;
  Outline object_outline(std::uint32_t reference) const;
  bool object_triangle(std::uint32_t reference, TriangleVertices& vertices) const;
  /// World box around all that an instance places; empty when nothing of it can be hit.
  Aabb instance_bounds(std::uint32_t instance) const;
  /// Union of all reference boxes; of a pose, a box around that and all instances.
  const Aabb& total_bounds() const { return bounds_; }

  /// What rays are prepared with: in world space, and in the object space of an instance.
  const RayFrame& world_frame() const { return world_frame_; }
  const RayFrame& object_frame(std::uint32_t instance) const { return object_frames_[instance]; }
  bool is_identity(std::uint32_t instance) const { return is_identity_[instance] != 0; }
  /// Whether there is a geometry without any mask bit, which no query sees.
  bool has_hidden_geometry() const { return has_hidden_geometry_; }

  /// Content hash of geometry, instances and ids (not of materials, view, warnings).
  std::uint64_t hash() const { return hash_; }

 private:
  static constexpr std::uint32_t kBlock = 64;
  struct Content;  ///< what all poses share; the spans below are views of it
  Scene(const Scene& base, std::span<const Affine> to_world);
  void place_instances();
  void check_extent() const;
  void widen_for_instances();
  void hash_instances();

  std::shared_ptr<const Content> content_;
  std::span<const Geometry> geometries_;
  std::span<const Part> parts_;
  std::span<const std::uint32_t> first_part_of_block_;
  std::span<const std::uint32_t> first_references_;  ///< per instance, and the end
  std::span<const RayFrame> object_frames_;
  std::vector<Instance> instances_;
  std::vector<Affine> to_object_;
  std::vector<std::uint8_t> is_identity_;
  RayFrame world_frame_;
  Aabb bounds_;
  std::uint32_t reference_count_ = 0;
  bool has_hidden_geometry_ = false;
  std::uint64_t hash_ = 0;
};

}  // namespace strahl
