// io/face_list.cpp - faces of a file to triangles.
#include <numeric>
#include <string>
#include <utility>

#include <strahl/geometry/polygon.h>
#include <strahl/io/face_list.h>

namespace strahl {
namespace {

template <class T>
VertexBuffer own(std::vector<Vec3<T>> vertices) {
  const auto owner = std::make_shared<const std::vector<Vec3<T>>>(std::move(vertices));
  return {{reinterpret_cast<const std::byte*>(owner->data()), owner->size(), sizeof(Vec3<T>),
           sizeof(T) == sizeof(double)},
          owner};
}

}  // namespace

VertexBuffer make_vertex_buffer(std::vector<Vec3f> vertices) { return own(std::move(vertices)); }
VertexBuffer make_vertex_buffer(std::vector<Vec3d> vertices) { return own(std::move(vertices)); }

FaceList::FaceList(VertexBuffer vertices) : vertices_(std::move(vertices)) {}

void FaceList::start_face_ids() {
  if (has_face_ids_) return;
  has_face_ids_ = true;
  face_ids_.resize(triangle_count());
  std::iota(face_ids_.begin(), face_ids_.end(), 0u);
}

void FaceList::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  indices_.push_back(a), indices_.push_back(b), indices_.push_back(c);
  if (has_face_ids_) face_ids_.push_back(face_count_);
}

void FaceList::add_polygon(std::span<const std::uint32_t> corners) {
  corner_points_.clear();
  for (const std::uint32_t corner : corners) corner_points_.push_back(vertices_.view[corner]);
  local_triangles_.clear();
  triangulate_polygon(corner_points_, local_triangles_);
  for (const auto& [a, b, c] : local_triangles_) add_triangle(corners[a], corners[b], corners[c]);
}

void FaceList::add(std::span<const std::uint32_t> corners) {
  if (corners.size() != 3) start_face_ids();
  if (corners.size() < 3) {
    ++skipped_;
  } else if (corners.size() == 3) {
    add_triangle(corners[0], corners[1], corners[2]);
  } else {
    add_polygon(corners);
  }
  ++face_count_;
}

Geometry FaceList::take_geometry() {
  struct Buffers {
    std::vector<std::uint32_t> indices;
    std::shared_ptr<const void> vertices;
  };
  const auto buffers = std::make_shared<const Buffers>(
      Buffers{std::move(indices_), std::move(vertices_.keep_alive)});
  Geometry geometry;
  geometry.mesh.vertices = vertices_.view;
  geometry.mesh.triangles = {reinterpret_cast<const std::byte*>(buffers->indices.data()),
                             buffers->indices.size() / 3, 3 * sizeof(std::uint32_t), false};
  geometry.mesh.keep_alive = buffers;
  geometry.face_ids = std::move(face_ids_);
  *this = FaceList({});
  return geometry;
}

void add_faces(FaceList& faces, SceneData& scene) {
  if (faces.skipped() > 0)
    scene.warnings.push_back(std::to_string(faces.skipped()) +
                             " faces with fewer than 3 vertices skipped");
  if (faces.triangle_count() > 0) {
    scene.geometries.push_back(faces.take_geometry());
  } else {
    scene.warnings.push_back("no triangles");
  }
}

}  // namespace strahl
