#include <strahl/structures/proximity_cloud/proximity_cloud.h>

#include <gtest/gtest.h>

#include <strahl/geometry/scene.h>

namespace strahl {
namespace {

TEST(ProximityCloud, AnEmptySceneHasAnEmptyLeaf) {
  const Scene scene{SceneData{}};
  const ProximityCloud structure(scene, {}, {});
  EXPECT_EQ(structure.report().empty_leaves, 1u);
  structure.validate(scene);
}

}  // namespace
}  // namespace strahl
