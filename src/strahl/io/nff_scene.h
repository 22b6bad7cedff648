// io/nff_scene.h - a scene as the Neutral File Format states it: polygons of any size, spheres,
// cones and the fills between them, in file order.
//
// The standard scenes are generated in this form, from which both SceneData and NFF files come.
// Invariants: objects lists every polygon, sphere and cone in file order; the k-th object of a kind
//   is entry k of that kind's array; fill indices are below fills.size(); polygons have 3 or more
//   corners.
// Thread safety: values.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <strahl/geometry/scene.h>

namespace strahl {

/// Corners vertices[first_vertex, first_vertex + vertex_count); a patch also has as many normals.
struct NffPolygon {
  static constexpr std::uint32_t kNoNormals = 0xffffffffu;
  std::uint32_t first_vertex = 0, vertex_count = 0;
  std::uint32_t first_normal = kNoNormals;

  bool is_patch() const { return first_normal != kNoNormals; }
};

enum class NffKind : std::uint8_t { polygon, sphere, cone };

/// One line group of the file: what it is and the fill it is under.
struct NffObject {
  NffKind kind;
  std::uint32_t fill;
};

struct NffScene {
  std::optional<Vec3d> background;
  std::optional<View> view;
  double hither = 0.0;  ///< near distance of the view; written, otherwise ignored
  std::vector<Vec3d> lights;
  std::vector<Material> fills;
  std::vector<Vec3d> vertices, normals;
  std::vector<NffPolygon> polygons;
  std::vector<Sphere> spheres;
  std::vector<Cone> cones;
  std::vector<NffObject> objects;

  std::uint32_t current_fill = 0;  ///< what the next object gets

  /// A new fill for what is added from now on. There must be one before the first object.
  void add_fill(const Material& fill);
  void add_polygon(std::span<const Vec3d> corners);
  void add_patch(std::span<const Vec3d> corners, std::span<const Vec3d> corner_normals);
  void add_sphere(const Vec3d& center, double radius);
  void add_cone(const Cone& cone);

 private:
  void add_object(NffKind kind);
};

/// The same scene as triangles (geometry 0), spheres (1) and cones (2); kinds that do not occur are
/// left out. face_ids number the polygons and patches in file order and are left out if all are
/// triangles. Materials are the fills. This is what read_nff() makes of the scene's file, except
/// that it has a material for each time a fill is written.
/// O(corners) for convex polygons. Throws Error{resource} above 2^32 - 2 corners.
SceneData to_scene_data(const NffScene& scene);

/// Any scene as NFF objects: triangles in world space, one polygon each, then spheres and cones.
/// Throws Error{usage} for spheres or cones under an instance that moves them; Error{bad_input} for
/// a material that does not exist.
NffScene to_nff_scene(const SceneData& data);

/// Rounds every number as C's printf("%g") prints it, to 6 significant digits.
void round_to_six_digits(NffScene& scene);

/// value as printf("%g") prints it, read back. Not finite values are kept.
double round_to_six_digits(double value);

}  // namespace strahl
