#include <algorithm>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/geometry/deform.h>

namespace strahl {
namespace {

void move_vertices(SceneData& data, const MovedVertices& moved) {
  const std::string where = "geometry " + std::to_string(moved.geometry);
  if (moved.geometry >= data.geometries.size() ||
      data.geometries[moved.geometry].kind != PrimitiveKind::triangle)
    throw Error(ErrorCode::usage, "there are no triangles to deform", data.source, where);
  TriangleMesh& mesh = data.geometries[moved.geometry].mesh;
  if (moved.vertices.count != mesh.vertices.count)
    throw Error(ErrorCode::usage,
                std::to_string(moved.vertices.count) + " vertices for " +
                    std::to_string(mesh.vertices.count),
                data.source, where);
  using Owners = std::pair<std::shared_ptr<const void>, std::shared_ptr<const void>>;
  mesh.vertices = moved.vertices;
  mesh.keep_alive = std::make_shared<const Owners>(mesh.keep_alive, moved.keep_alive);
}

bool is_same_run(const Instance& a, const Instance& b) {
  return a.first_geometry == b.first_geometry && a.geometry_count == b.geometry_count &&
         a.instance_id == b.instance_id;
}

bool has_same_numbers(const Geometry& a, const Geometry& b) {
  const IndexView &x = a.mesh.triangles, &y = b.mesh.triangles;
  return a.kind == b.kind && a.size() == b.size() && a.geometry_id == b.geometry_id &&
         a.mask == b.mask && x.data == y.data && x.stride == y.stride && x.is_64_bit == y.is_64_bit;
}

}  // namespace

Scene deformed(const Scene& scene, std::span<const MovedVertices> moved) {
  SceneData data = scene.data();
  data.instances = scene.instances();
  for (const MovedVertices& m : moved) move_vertices(data, m);
  return Scene(std::move(data));
}

bool has_same_things(const Scene& a, const Scene& b) {
  return std::equal(a.instances().begin(), a.instances().end(), b.instances().begin(),
                    b.instances().end(), is_same_run) &&
         std::equal(a.geometries().begin(), a.geometries().end(), b.geometries().begin(),
                    b.geometries().end(), has_same_numbers);
}

}  // namespace strahl
