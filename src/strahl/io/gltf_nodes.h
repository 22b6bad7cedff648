// io/gltf_nodes.h - the node hierarchy of a glTF file: order of visit and world transforms.
//
// Invariants: the hierarchy is a forest (checked); nothing recurses, so depth is unlimited.
// Thread safety: values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <strahl/io/gltf_document.h>
#include <strahl/io/rig.h>
#include <strahl/math/affine.h>

namespace strahl::gltf {

struct NodeTree {
  Rig rig;                           ///< of every node of the file; no mounts yet
  std::vector<Affine> to_world;      ///< at rest; not finite where hopeless
  std::vector<std::uint32_t> order;  ///< nodes of the scene, depth-first in file order
};

/// Reads all nodes and the scene to show: `scene`, else the first; without scenes the order is
/// empty and a warning is left. Throws Error{bad_input}: a node with two parents, a cycle, a
/// scene listing a child or the same node twice, malformed transforms.
NodeTree read_nodes(Document& document);

/// A column-major 4x4 matrix. Reports `place` where its last row is not 0 0 0 1.
Affine from_columns(const std::array<double, 16>& columns, const JsonValue& place);

}  // namespace strahl::gltf
