// Cells and references of octrees as published for the standard scenes.
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <strahl/catalog/catalog.h>
#include <strahl/io/generators.h>

namespace strahl::test {
namespace {

using ScenePtr = std::shared_ptr<const Scene>;

/// What a paper reports of an octree.
struct Published {
  int depth;
  std::uint64_t leaves, empty_leaves, references;
};

BuildReport as_published(const ScenePtr& scene, int depth, const std::string& more) {
  const auto tree = build(scene, "octree:exact=off,max_prims=1,max_growth=1000,max_depth=" +
                                     std::to_string(depth) + more);
  EXPECT_NO_THROW(tree->validate());
  return tree->report();
}

/// [Havran1999], Octree84-C: leaves of one object, objects in all cells that their boxes touch.
TEST(OctreeCounts, HasThePublishedCellsAndReferencesOfTetra) {
  const auto scene = std::make_shared<const Scene>(generate_scene("tetra:6"));
  ASSERT_EQ(scene->size(), 4096u);
  for (const Published& p :
       {Published{4, 2136, 1072, 13312}, Published{5, 9584, 4764, 32768},
        Published{6, 43324, 21100, 110592}, Published{7, 198892, 80444, 512000}}) {
    const BuildReport report = as_published(scene, p.depth, "");
    EXPECT_EQ(report.leaves, p.leaves) << p.depth;
    EXPECT_EQ(report.references, p.references) << p.depth;
    EXPECT_EQ(report.empty_leaves, p.empty_leaves) << p.depth;
    EXPECT_EQ(report.depth, static_cast<std::uint64_t>(p.depth));
  }
}

}  // namespace
}  // namespace strahl::test
