// tests/support/mesh_maker.h - small triangle scenes for the tests of structures.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <strahl/base/rng.h>
#include <strahl/geometry/scene.h>

namespace strahl::test {

using ScenePtr = std::shared_ptr<const Scene>;

/// Collects corners of triangles and quadrilaterals.
struct MeshMaker {
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;

  void triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    for (const Vec3d& v : {a, b, c}) {
      indices.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(v);
    }
  }
  void quad(const Vec3d& a, const Vec3d& u, const Vec3d& v) {
    triangle(a, a + u, a + u + v);
    triangle(a, a + u + v, a + v);
  }
  Geometry geometry() const {
    Geometry g;
    g.mesh = make_mesh(vertices, indices);
    return g;
  }
  ScenePtr scene() const {
    SceneData data;
    data.geometries.push_back(geometry());
    return std::make_shared<const Scene>(std::move(data));
  }
};

inline Vec3d axis_vector(int axis, double length) {
  Vec3d v;
  v[axis] = length;
  return v;
}

/// Walls of a lattice of rooms: everything lies exactly on planes that are candidates.
inline MeshMaker walls(int rooms, double step, const Vec3d& origin) {
  MeshMaker mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i <= rooms; ++i)
      for (int j = 0; j < rooms; ++j)
        for (int k = 0; k < rooms; ++k) {
          if ((i * 7 + j * 5 + k * 3 + axis) % 4 == 0) continue;  // a door
          Vec3d at;
          at[axis] = i, at[(axis + 1) % 3] = j, at[(axis + 2) % 3] = k;
          mesh.quad(origin + step * at, axis_vector((axis + 1) % 3, step),
                    axis_vector((axis + 2) % 3, step));
        }
  return mesh;
}

/// Triangles with corners within `size` of centres in the unit cube.
inline MeshMaker soup(std::size_t count, double size, std::uint64_t seed) {
  Rng rng(seed);
  MeshMaker mesh;
  const auto near = [&](const Vec3d& c, double reach) {
    return c + Vec3d{rng.uniform(-reach, reach), rng.uniform(-reach, reach),
                     rng.uniform(-reach, reach)};
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d c = near({0.5, 0.5, 0.5}, 0.5);
    mesh.triangle(near(c, size), near(c, size), near(c, size));
  }
  return mesh;
}

}  // namespace strahl::test
