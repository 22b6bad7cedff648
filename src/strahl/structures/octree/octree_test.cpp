#include <gtest/gtest.h>

#include <strahl/catalog/catalog.h>
#include <strahl/io/generators.h>
#include <strahl/structures/octree/octree.h>

namespace strahl {
namespace {

TEST(Octree, AnEmptySceneHasAnEmptyLeaf) {
  const Scene scene{SceneData{}};
  const Octree structure(scene, {}, {});
  EXPECT_EQ(structure.report().empty_leaves, 1u);
  structure.validate(scene);
}

}  // namespace
}  // namespace strahl
