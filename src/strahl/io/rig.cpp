#include <cmath>

#include <strahl/base/error.h>
#include <strahl/io/rig.h>

namespace strahl {

Affine compose_trs(const Vec3d& translation, const std::array<double, 4>& rotation,
                   const Vec3d& scale) {
  const auto [x, y, z, w] = rotation;
  Affine result = Affine::translation(translation);
  // Without this shortcut -0 and rounding would creep into plain translations.
  if (rotation != std::array<double, 4>{0, 0, 0, 1}) {
    const double norm = std::sqrt((x * x + y * y) + (z * z + w * w));
    result = result * Affine::rotation(x / norm, y / norm, z / norm, w / norm);
  }
  if (!(scale == Vec3d(1, 1, 1))) result = result * Affine::scaling(scale);
  return result;
}

Affine NodePlace::local() const {
  return matrix ? *matrix : compose_trs(translation, rotation, scale);
}

std::vector<Affine> Rig::to_world(const std::vector<NodePlace>& places) const {
  std::vector<Affine> world(nodes.size());
  for (const std::uint32_t n : order) {
    const std::uint32_t parent = nodes[n].parent;
    const Affine local = places[n].local();
    world[n] = parent == RigNode::kNoParent ? local : world[parent] * local;
  }
  return world;
}

std::uint32_t find_node(const Rig& rig, const std::string& name, const std::string& source,
                        const std::string& where) {
  std::uint32_t found = RigNode::kNoParent;
  for (std::uint32_t n = 0; n < rig.nodes.size(); ++n) {
    if (rig.nodes[n].name != name) continue;
    if (found != RigNode::kNoParent)
      throw Error(ErrorCode::bad_input,
                  "nodes " + std::to_string(found) + " and " + std::to_string(n) +
                      " both have this name; give the number",
                  source, where);
    found = n;
  }
  if (found == RigNode::kNoParent)
    throw Error(ErrorCode::bad_input, "the scene has no node of this name", source, where);
  return found;
}

Rig flat_rig(const SceneData& scene) {
  Rig rig;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    RigNode node;
    if (!scene.instances[i].to_world.is_identity()) node.rest.matrix = scene.instances[i].to_world;
    rig.nodes.push_back(std::move(node));
    rig.order.push_back(i);
    rig.mounts.push_back(Mount{i, {}});
  }
  return rig;
}

}  // namespace strahl
