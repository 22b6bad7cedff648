// io/gltf_instancing.h - the extension EXT_mesh_gpu_instancing: many copies of a node's mesh.
//
// Thread safety: one thread.
#pragma once

#include <vector>

#include <strahl/io/gltf_accessor.h>
#include <strahl/math/affine.h>

namespace strahl::gltf {

/// Transforms of the copies below the node's own; a single identity without the extension.
/// Throws Error{bad_input}: attributes of different lengths or wrong types.
std::vector<Affine> read_copies(Accessors& accessors, const JsonValue& node);

}  // namespace strahl::gltf
