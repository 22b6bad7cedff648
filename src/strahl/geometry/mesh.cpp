#include <utility>

#include <strahl/geometry/mesh.h>

namespace strahl {
namespace {

template <class T>
TriangleMesh make_owning_mesh(std::vector<Vec3<T>> vertices, std::vector<std::uint32_t> indices) {
  struct Buffers {
    std::vector<Vec3<T>> vertices;
    std::vector<std::uint32_t> indices;
  };
  auto buffers = std::make_shared<Buffers>(Buffers{std::move(vertices), std::move(indices)});
  TriangleMesh mesh;
  mesh.vertices = {reinterpret_cast<const std::byte*>(buffers->vertices.data()),
                   buffers->vertices.size(), sizeof(Vec3<T>), sizeof(T) == sizeof(double)};
  mesh.triangles = {reinterpret_cast<const std::byte*>(buffers->indices.data()),
                    buffers->indices.size() / 3, 3 * sizeof(std::uint32_t), false};
  mesh.keep_alive = std::move(buffers);
  return mesh;
}

}  // namespace

TriangleMesh make_mesh(std::vector<Vec3f> vertices, std::vector<std::uint32_t> indices) {
  return make_owning_mesh(std::move(vertices), std::move(indices));
}

TriangleMesh make_mesh(std::vector<Vec3d> vertices, std::vector<std::uint32_t> indices) {
  return make_owning_mesh(std::move(vertices), std::move(indices));
}

}  // namespace strahl
