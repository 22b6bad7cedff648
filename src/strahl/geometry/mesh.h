// geometry/mesh.h - indexed triangle meshes over memory the caller owns or hands over.
//
// Layout: vertices are a strided array of 3 float32 or float64, triangles a strided array of 3
//   uint32 or uint64 vertex indices; nothing is copied or converted at load.
// Invariants (checked when a Scene is made): every index < vertex count; float64 coordinates are
//   0 or of magnitude 2^-240..2^240 or not finite.
// Thread safety: immutable after construction; const access from any number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include <strahl/math/aabb.h>

namespace strahl {

/// Strided view of 3-component float32 or float64 positions. Does not own the memory.
struct VertexView {
  const std::byte* data = nullptr;
  std::size_t count = 0;
  std::size_t stride = 0;  ///< bytes from one vertex to the next; need not be aligned
  bool is_double = false;

  /// Vertex i, float32 promoted exactly. i < count.
  Vec3d operator[](std::size_t i) const {
    const std::byte* p = at(i);
    if (is_double) return load<double>(p);
    return Vec3d(load<float>(p));
  }
  const std::byte* at(std::size_t i) const { return data + i * stride; }

 private:
  template <class T>
  static Vec3<T> load(const std::byte* p) {
    T v[3];
    std::memcpy(v, p, sizeof v);
    return {v[0], v[1], v[2]};
  }
};

/// Strided view of triangles, 3 vertex indices of 32 or 64 bits each. Does not own the memory.
struct IndexView {
  const std::byte* data = nullptr;
  std::size_t count = 0;   ///< triangles
  std::size_t stride = 0;  ///< bytes from one triangle to the next
  bool is_64_bit = false;

  struct Triple {
    std::uint64_t a, b, c;
  };
  Triple operator[](std::size_t i) const {
    const std::byte* p = at(i);
    if (is_64_bit) return load<std::uint64_t>(p);
    return load<std::uint32_t>(p);
  }
  const std::byte* at(std::size_t i) const { return data + i * stride; }

 private:
  template <class T>
  static Triple load(const std::byte* p) {
    T v[3];
    std::memcpy(v, p, sizeof v);
    return {v[0], v[1], v[2]};
  }
};

/// The three corners of a triangle in vertex order.
struct TriangleVertices {
  Vec3d a, b, c;
  Aabb bounds() const {
    Aabb box;
    box.extend(a), box.extend(b), box.extend(c);
    return box;
  }
};

/// An indexed triangle mesh. `keep_alive` holds owned buffers; with a null one the caller keeps
/// the memory alive and unchanged for as long as any Scene or Accelerator made from it lives.
struct TriangleMesh {
  VertexView vertices;
  IndexView triangles;
  std::shared_ptr<const void> keep_alive;

  std::size_t size() const { return triangles.count; }
  TriangleVertices operator[](std::size_t i) const {
    const IndexView::Triple t = triangles[i];
    return {vertices[t.a], vertices[t.b], vertices[t.c]};
  }
};

/// A mesh that owns its buffers. `indices` holds 3 entries per triangle.
TriangleMesh make_mesh(std::vector<Vec3f> vertices, std::vector<std::uint32_t> indices);
TriangleMesh make_mesh(std::vector<Vec3d> vertices, std::vector<std::uint32_t> indices);

}  // namespace strahl
