// io/gltf.h - reads glTF 2.0, as text (.gltf) or container (.glb), into a scene with instances.
//
// Format: Khronos glTF 2.0 specification; the container is recognised by its magic bytes.
// Ids: instance_id counts mesh nodes of the scene depth-first in file order (each copy made by
//   EXT_mesh_gpu_instancing counts), geometry_id counts (mesh, primitive) in file order.
// Pose: the file's default scene, else its first one; node transforms, morph targets by default
//   weights, skins by the joints' node transforms; animations are read beside it.
// Thread safety: no shared state.
#pragma once

#include <strahl/geometry/scene.h>
#include <strahl/io/deform.h>
#include <strahl/io/file_bytes.h>

namespace strahl {

/// Reads a glTF or GLB file.
/// @param file mapped or in memory; buffers beside it are looked up in file.folder and below only.
/// @return meshes kept once and instanced by nodes. Float positions, and 32-bit indices of triangle
///   lists, are views of the file (file.owner keeps them alive). What a skin or a node's own morph
///   weights deform becomes a geometry of its own, skins in world space. Materials carry the base
///   colour factor; the first perspective camera of the scene becomes the view. Points and lines
///   are skipped, instances with a singular transform dropped, each with a warning.
/// Throws Error{bad_input} citing the byte or the JSON pointer: malformed JSON or container, wrong
///   types, indices and byte ranges out of bounds, buffers missing or outside the folder, nodes
///   with two parents or in a cycle, required extensions that are not supported; Error{resource}:
///   data that expands far beyond the size of the file.
/// Complexity: O(file size + nodes), except that each skinned node costs its vertices.
SceneData read_gltf(const FileBytes& file);

/// The same with the hierarchy of nodes, the file's animations and what they deform: a mesh whose
/// morph weights are animated is a geometry of its own for each node. Throws also as
/// gltf::read_animations().
RiggedScene read_rigged_gltf(const FileBytes& file);

}  // namespace strahl
