#include <algorithm>
#include <numeric>
#include <utility>

#include <strahl/measure/thinned.h>

namespace strahl {
namespace {

/// Primitives that an instance keeps at least, as far as it has them.
constexpr std::uint64_t kPerInstance = 8;

std::uint64_t rounded_up(std::uint64_t a, std::uint64_t b) {
  return (a + b - 1) / std::max<std::uint64_t>(b, 1);
}

/// Every step-th item from the middle of the first step, at least one where there are any.
template <class T>
std::vector<T> every(const std::vector<T>& items, std::size_t step) {
  std::vector<T> some;
  for (std::size_t i = std::min(step / 2, items.empty() ? 0 : items.size() - 1); i < items.size();
       i += step)
    some.push_back(items[i]);
  return some;
}

std::vector<std::uint32_t> all_indices(std::uint64_t count) {
  std::vector<std::uint32_t> indices(count);
  std::iota(indices.begin(), indices.end(), 0u);
  return indices;
}

template <class V>
TriangleMesh every_triangle(const TriangleMesh& mesh, std::size_t step) {
  std::vector<V> vertices;
  std::vector<std::uint32_t> indices;
  for (std::size_t i = std::min(step / 2, mesh.size() - 1); i < mesh.size(); i += step) {
    const TriangleVertices t = mesh[i];
    for (const Vec3d& p : {t.a, t.b, t.c}) {
      indices.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(V(p));
    }
  }
  return make_mesh(std::move(vertices), std::move(indices));
}

Geometry thinned(const Geometry& geometry, std::size_t step) {
  Geometry some;
  some.kind = geometry.kind, some.geometry_id = geometry.geometry_id, some.mask = geometry.mask;
  if (geometry.mesh.size() > 0)
    some.mesh = geometry.mesh.vertices.is_double ? every_triangle<Vec3d>(geometry.mesh, step)
                                                 : every_triangle<Vec3f>(geometry.mesh, step);
  some.spheres = every(geometry.spheres, step);
  some.cones = every(geometry.cones, step);
  some.materials = every(geometry.materials, step);
  return some;
}

}  // namespace

std::shared_ptr<const Scene> thinned(const std::shared_ptr<const Scene>& scene,
                                     std::uint32_t count) {
  count = std::max(count, 1u);
  if (scene->size() <= count) return scene;
  const SceneData& data = scene->data();
  const std::uint64_t instances = scene->instances().size();
  const std::uint64_t least = std::min(scene->size() / instances, kPerInstance) * instances;
  const std::vector<std::uint32_t> kept =
      every(all_indices(instances), std::max<std::uint64_t>(rounded_up(least, count), 1));

  SceneData some;
  some.materials = data.materials, some.view = data.view, some.lights = data.lights;
  some.source = data.source;
  std::uint64_t references = 0;
  for (const std::uint32_t i : kept) {
    some.instances.push_back(scene->instances()[i]);
    references += scene->reference_count(i);
  }
  const std::size_t step = std::max<std::uint64_t>(rounded_up(references, count), 1);
  for (const Geometry& geometry : scene->geometries())
    some.geometries.push_back(thinned(geometry, step));
  return std::make_shared<const Scene>(std::move(some));
}

}  // namespace strahl
