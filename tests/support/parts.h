// tests/support/parts.h - ten real parts among the shared scenes, on which volumes are judged.
#pragma once

#include <string>
#include <tests/support/shared.h>
#include <vector>

#include <strahl/io/load.h>

namespace strahl::test {

/// CAD parts, scans, modelled characters and a plant; single meshes without instances.
inline const std::vector<std::string>& real_parts() {
  static const std::vector<std::string> names{"1002_tray_bottom.STL", "ADIS16480.STL",
                                              "extruder-body.stl",    "cycloidal.ply",
                                              "stanford-bunny.ply",   "dragon_vrip_res3.ply",
                                              "teapot.obj",           "spot.obj",
                                              "suzanne.obj",          "bamboo.ply"};
  return names;
}

inline SceneData part(const std::string& name) {
  return load_scene_data((shared_dir() / "scenes" / name).string());
}

/// All triangles of a part.
inline std::vector<TriangleVertices> triangles_of(const std::string& name) {
  std::vector<TriangleVertices> triangles;
  const SceneData data = part(name);
  for (const Geometry& g : data.geometries)
    for (std::size_t i = 0; i < g.mesh.size(); ++i) triangles.push_back(g.mesh[i]);
  return triangles;
}

/// All vertices of a part.
inline std::vector<Vec3d> vertices_of(const std::string& name) {
  std::vector<Vec3d> vertices;
  const SceneData data = part(name);
  for (const Geometry& g : data.geometries)
    for (std::size_t i = 0; i < g.mesh.vertices.count; ++i) vertices.push_back(g.mesh.vertices[i]);
  return vertices;
}

}  // namespace strahl::test
