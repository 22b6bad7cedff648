// io/generator_mesh.h - building blocks of generated meshes: a growing mesh, the unit icosphere.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <strahl/geometry/scene.h>

namespace strahl {

/// Vertices and triangles under construction.
template <class T>
struct MeshParts {
  std::vector<Vec3<T>> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> materials;  ///< per triangle; may stay empty

  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(vertices.size()); }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    indices.insert(indices.end(), {a, b, c});
  }
};

/// A scene of this one mesh, geometry 0.
template <class T>
SceneData scene_of(MeshParts<T> parts) {
  SceneData data;
  Geometry& geometry = data.geometries.emplace_back();
  geometry.materials = std::move(parts.materials);
  geometry.mesh = make_mesh(std::move(parts.vertices), std::move(parts.indices));
  return data;
}

/// A box as 8 vertices and 12 triangles, outward winding: center +- the three half axes, which
/// must be right-handed.
void add_box(MeshParts<float>& parts, const Vec3d& center, const std::array<Vec3d, 3>& half_axes);

/// Unit sphere of 20 * 4^level triangles: an icosahedron, every triangle cut into four at its edge
/// midpoints, which are pushed onto the sphere. Outward winding, each vertex once. O(triangles).
MeshParts<double> unit_icosphere(int level);

/// Triangles of unit_icosphere(level).
double icosphere_triangles(int level);

}  // namespace strahl
