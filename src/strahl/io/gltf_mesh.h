// io/gltf_mesh.h - primitives of glTF meshes as triangle meshes.
//
// Layout: float positions and packed 32-bit indices of triangle lists are views of the file;
//   everything else is converted, indices once per accessor and mode.
// Invariants: every index of a mesh returned is below its vertex count.
// Thread safety: one thread.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include <strahl/geometry/mesh.h>
#include <strahl/io/gltf_accessor.h>

namespace strahl::gltf {

/// The modes that make triangles, by their numbers in the format.
enum class Mode : std::uint32_t { triangles = 4, strip = 5, fan = 6 };

/// Triangles as vertex indices.
struct Triangles {
  IndexView view;
  std::uint32_t max_index = 0;
  std::shared_ptr<const void> owner;
};

class MeshReader {
 public:
  explicit MeshReader(Accessors& accessors) : accessors_(accessors) {}

  /// The triangles of a primitive with the positions it states; empty, with a warning, for points,
  /// lines and primitives without positions. Throws Error{bad_input}: as Accessors, and an index
  /// that is not below the vertex count.
  TriangleMesh read(const JsonValue& primitive);

  Accessors& accessors() const { return accessors_; }

 private:
  const Triangles& indexed(const JsonValue& indices, Mode mode);
  const Triangles& in_order(std::size_t vertex_count, Mode mode, const JsonValue& place);

  Accessors& accessors_;
  std::map<std::tuple<const Array*, std::size_t, Mode>, Triangles> triangles_;
};

/// The accessor of POSITION, checked: VEC3 of floats, or of small integers (KHR_mesh_quantization).
const Array& read_positions(Accessors& accessors, const JsonValue& reference);

/// The same triangles over other positions of the same count.
TriangleMesh with_positions(const TriangleMesh& mesh, std::vector<Vec3f> positions);

}  // namespace strahl::gltf
