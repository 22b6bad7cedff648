#include <gtest/gtest.h>

#include <strahl/geometry/scene.h>
#include <strahl/structures/bih/bih.h>

namespace strahl {
namespace {

TEST(Bih, AnEmptySceneHasNoNodes) {
  const Scene scene{SceneData{}};
  const Bih structure(scene, {}, {});
  EXPECT_EQ(structure.report().nodes, 0u);
  structure.validate(scene);
}

}  // namespace
}  // namespace strahl
