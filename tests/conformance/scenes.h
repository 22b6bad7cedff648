// tests/conformance/scenes.h - adversarial scenes: each has broken a ray tracer somewhere.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <strahl/geometry/scene.h>

namespace strahl::test {

struct NamedScene {
  std::string name;
  std::function<SceneData()> make;
  bool is_tiny;  ///< small enough for the full product of options
};

/// All adversarial scenes, tiny ones first. At most about 2,000 primitives each.
const std::vector<NamedScene>& adversarial_scenes();

/// The scene, made once per process.
std::shared_ptr<const Scene> scene_of(const NamedScene& named);

}  // namespace strahl::test
