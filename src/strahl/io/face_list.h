// io/face_list.h - turns the faces of a file, in order, into a triangle mesh with source faces.
//
// Layout: 3 uint32 vertex indices per triangle; face ids exist only once a face was not a triangle.
// Thread safety: a value; one thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <strahl/geometry/scene.h>

namespace strahl {

/// Vertices and what keeps their memory alive.
struct VertexBuffer {
  VertexView view;
  std::shared_ptr<const void> keep_alive;
};

/// Takes over the vertices.
VertexBuffer make_vertex_buffer(std::vector<Vec3f> vertices);
VertexBuffer make_vertex_buffer(std::vector<Vec3d> vertices);

/// Collects the faces of one geometry. Faces are numbered from 0 in the order they are added,
/// those without an area of their own (fewer than 3 corners) too.
class FaceList {
 public:
  explicit FaceList(VertexBuffer vertices);

  /// Adds the next face: n-2 triangles of n corners, none of fewer than 3.
  /// Requires: every corner < vertex count. Complexity: that of triangulate_polygon.
  void add(std::span<const std::uint32_t> corners);

  /// Faces with fewer than 3 corners so far.
  std::size_t skipped() const { return skipped_; }
  std::size_t triangle_count() const { return indices_.size() / 3; }

  /// The triangles as a geometry, which shares the vertices and owns the indices. Empties this.
  Geometry take_geometry();

 private:
  void start_face_ids();
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  void add_polygon(std::span<const std::uint32_t> corners);

  VertexBuffer vertices_;
  std::vector<std::uint32_t> indices_, face_ids_;
  std::vector<Vec3d> corner_points_;                           // scratch of add_polygon
  std::vector<std::array<std::uint32_t, 3>> local_triangles_;  // scratch of add_polygon
  std::uint32_t face_count_ = 0;
  std::size_t skipped_ = 0;
  bool has_face_ids_ = false;
};

/// What every reader does last: adds the triangles to the scene, or a warning that there are none,
/// and a warning with the number of skipped faces.
void add_faces(FaceList& faces, SceneData& scene);

}  // namespace strahl
