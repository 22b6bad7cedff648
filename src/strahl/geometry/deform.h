// geometry/deform.h - scenes whose triangles have moved vertices: the same things with the same
// numbers in another shape.
//
// Thread safety: pure functions.
#pragma once

#include <memory>
#include <span>

#include <strahl/geometry/scene.h>

namespace strahl {

/// New vertices for a geometry of triangles, as many as it has. keep_alive as in TriangleMesh.
struct MovedVertices {
  std::uint32_t geometry;  ///< index into Scene::geometries()
  VertexView vertices;
  std::shared_ptr<const void> keep_alive;
};

/// The same triangles between moved vertices, the instances where the scene has them: for all
/// queries as if loaded so. O(primitives + vertices). Keeps alive the vertices it comes from: of
/// many frames, each is best made of the scene at rest.
/// Throws Error{usage}: a geometry that is not of triangles or has another number of vertices;
///   Error{bad_input} as the constructor of Scene does for vertices.
Scene deformed(const Scene& scene, std::span<const MovedVertices> moved);

/// Whether both have the same things under the same numbers, wherever these are: instances of the
/// same geometries in the same order, triangles by the same index arrays in memory. O(instances +
/// geometries).
bool has_same_things(const Scene& a, const Scene& b);

}  // namespace strahl
