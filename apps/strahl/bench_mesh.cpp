#include <apps/strahl/bench_mesh.h>
#include <cmath>

namespace strahl::cli {
namespace {

template <class Vertex>
std::shared_ptr<const Scene> scene_of(std::vector<Vertex> vertices,
                                      std::vector<std::uint32_t> indices) {
  SceneData data;
  data.geometries.emplace_back().mesh = make_mesh(std::move(vertices), std::move(indices));
  return std::make_shared<const Scene>(std::move(data));
}

double largest_extent(const Aabb& box) { return box.extent()[box.longest_axis()]; }

}  // namespace

FlatMesh flat_mesh(const Scene& scene) {
  FlatMesh flat;
  for (const Part& part : scene.parts()) {
    const Geometry& geometry = scene.geometries()[part.geometry];
    if (geometry.kind != PrimitiveKind::triangle) continue;
    const Affine& to_world = scene.instances()[part.instance].to_world;
    const auto first = static_cast<std::uint32_t>(flat.vertices.size());
    const TriangleMesh& mesh = geometry.mesh;
    for (std::size_t i = 0; i < mesh.vertices.count; ++i)
      flat.vertices.push_back(to_world.point(mesh.vertices[i]));
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      const IndexView::Triple t = mesh.triangles[i];
      for (const std::uint64_t corner : {t.a, t.b, t.c})
        flat.indices.push_back(first + static_cast<std::uint32_t>(corner));
    }
  }
  return flat;
}

double coarse_step(const Aabb& box) {
  return std::exp2(std::ceil(std::log2(largest_extent(box))) - 20.0);
}

Vec3d snapped(const Vec3d& point, double step) {
  Vec3d out;
  for (int axis = 0; axis < 3; ++axis) out[axis] = std::round(point[axis] / step) * step;
  // Far from the origin floats are further apart than the step, and multiples of it themselves.
  return Vec3d(Vec3f(out));
}

std::shared_ptr<const Scene> float_scene(const FlatMesh& mesh) {
  std::vector<Vec3f> vertices;
  for (const Vec3d& v : mesh.vertices) vertices.push_back(Vec3f(v));
  return scene_of(std::move(vertices), mesh.indices);
}

std::shared_ptr<const Scene> double_scene(const FlatMesh& mesh, const Aabb& box) {
  const double tiny = largest_extent(box) * 0x1p-40;
  std::vector<Vec3d> vertices;
  for (const Vec3d& v : mesh.vertices) {
    Vec3d moved = Vec3d(Vec3f(v));
    for (int axis = 0; axis < 3; ++axis)
      moved[axis] = moved[axis] == 0.0 ? tiny * (1.0 + 0x1p-30) : moved[axis] * (1.0 + 0x1.8p-26);
    vertices.push_back(moved);
  }
  return scene_of(std::move(vertices), mesh.indices);
}

}  // namespace strahl::cli
