#include <gtest/gtest.h>

#include <strahl/geometry/scene.h>
#include <strahl/structures/ternary_tree/ternary_tree.h>

namespace strahl {
namespace {

TEST(TernaryTree, AnEmptySceneHasAnEmptyLeaf) {
  const Scene scene{SceneData{}};
  const TernaryTree structure(scene, {}, {});
  EXPECT_EQ(structure.report().empty_leaves, 1u);
  structure.validate(scene);
}

}  // namespace
}  // namespace strahl
