// apps/strahl/bench_mesh.h - scenes made from another's triangles for a special purpose.
//
// Thread safety: pure functions.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <strahl/geometry/scene.h>

namespace strahl::cli {

/// Triangles of a scene in world space.
struct FlatMesh {
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;  ///< three per triangle

  std::size_t size() const { return indices.size() / 3; }
  TriangleVertices operator[](std::size_t i) const {
    return {vertices[indices[3 * i]], vertices[indices[3 * i + 1]], vertices[indices[3 * i + 2]]};
  }
};

/// The triangles of all instances; curved primitives are left out. O(triangles + vertices).
FlatMesh flat_mesh(const Scene& scene);

/// A grid of numbers 2^-20 of the box's largest extent apart, rounded up to a power of two. Any two
/// of them within a few extents of the box differ by a float.
double coarse_step(const Aabb& box);
/// The nearest multiple of the step that is a float.
Vec3d snapped(const Vec3d& point, double step);

/// The mesh with its vertices rounded to float32, as one geometry.
std::shared_ptr<const Scene> float_scene(const FlatMesh& mesh);
/// The same with each coordinate a quarter of a float's last place further from 0: float64 that no
/// float32 is, but that rounds to the same float32. 0 becomes a number of that size for `box`.
std::shared_ptr<const Scene> double_scene(const FlatMesh& mesh, const Aabb& box);

}  // namespace strahl::cli
