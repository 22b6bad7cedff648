// io/rig.h - what can move a scene: its hierarchy of nodes, and where each instance hangs in it.
//
// Places of nodes are relative to their parents, as in glTF: translation, rotation and scale, or a
// matrix. The world transform of an instance is its node's times a fixed transform of its own.
// Thread safety: values.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <strahl/geometry/scene.h>

namespace strahl {

/// Where a node stands below its parent.
struct NodePlace {
  Vec3d translation;
  std::array<double, 4> rotation{0, 0, 0, 1};  ///< x, y, z, w
  Vec3d scale{1, 1, 1};
  std::optional<Affine> matrix;  ///< instead of the others

  Affine local() const;
};

/// Translation, rotation (x, y, z, w; normalised here, all zero gives NaN) and scale, composed.
Affine compose_trs(const Vec3d& translation, const std::array<double, 4>& rotation,
                   const Vec3d& scale);

struct RigNode {
  static constexpr std::uint32_t kNoParent = UINT32_MAX;

  std::string name;
  std::uint32_t parent = kNoParent;
  NodePlace rest;
};

/// The node that carries an instance, and where the instance is below it.
struct Mount {
  std::uint32_t node;
  Affine copy;
};

struct Rig {
  std::vector<RigNode> nodes;
  std::vector<std::uint32_t> order;          ///< of all nodes, parents before children
  std::vector<std::optional<Mount>> mounts;  ///< per instance; nothing: does not move

  /// World transforms of all nodes. @param places one per node
  std::vector<Affine> to_world(const std::vector<NodePlace>& places) const;
};

/// The number of the node of that name. Throws Error{bad_input} when there is none or more than
/// one; `source` and `where` say who asked.
std::uint32_t find_node(const Rig& rig, const std::string& name, const std::string& source,
                        const std::string& where);

/// Each instance by itself, without names: for formats without a hierarchy.
Rig flat_rig(const SceneData& scene);

}  // namespace strahl
