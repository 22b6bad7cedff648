#include <array>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>
#include <strahl/structures/quadtree/quadtree.h>

namespace strahl {
namespace {

using ScenePtr = std::shared_ptr<const Scene>;
using Triangle = std::array<Vec3d, 3>;

ScenePtr triangles(const std::vector<Triangle>& all) {
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (const Triangle& triangle : all)
    for (const Vec3d& v : triangle) {
      indices.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(v);
    }
  SceneData data;
  Geometry geometry;
  geometry.mesh = make_mesh(vertices, indices);
  data.geometries.push_back(std::move(geometry));
  return std::make_shared<const Scene>(std::move(data));
}

/// Small triangles in [0, 3] x [0, 2] x [0, 1].
ScenePtr soup() {
  Rng rng(1);
  std::vector<Triangle> all;
  for (int i = 0; i < 1000; ++i) {
    const Vec3d c{rng.uniform(0, 3), rng.uniform(0, 2), rng.uniform()};
    const auto near = [&] {
      return c + Vec3d{rng.uniform(0, 0.02), rng.uniform(0, 0.02), rng.uniform(0, 0.02)};
    };
    all.push_back({near(), near(), near()});
  }
  return triangles(all);
}

TEST(Quadtree, AnEmptySceneHasAnEmptyLeaf) {
  const Scene scene{SceneData{}};
  const Quadtree structure(scene, {}, {});
  EXPECT_EQ(structure.report().empty_leaves, 1u);
  structure.validate(scene);
}

/// Inner cells have four children each, so leaves are three times as many and one.
TEST(Quadtree, DividesCellsIntoFour) {
  for (const char* options : {"", ",place=inner", ",split=middle", ",place=inner,looseness=2"}) {
    const auto tree = build(soup(), std::string("quadtree:max_prims=1") + options);
    EXPECT_NO_THROW(tree->validate());
    const BuildReport& report = tree->report();
    EXPECT_GT(report.leaves, 64u);
    EXPECT_EQ(report.leaves, 3 * (report.nodes - report.leaves) + 1) << options;
  }
}

TEST(Quadtree, LeavesTheShortestAxisUndividedUnlessToldOtherwise) {
  const ScenePtr scene = soup();
  const std::uint64_t standard = build(scene, "quadtree")->tree_hash();
  EXPECT_EQ(build(scene, "quadtree:undivided=z")->tree_hash(), standard);
  EXPECT_NE(build(scene, "quadtree:undivided=x")->tree_hash(), standard);
  EXPECT_NE(build(scene, "quadtree:undivided=y")->tree_hash(), standard);
  EXPECT_NE(build(scene, "quadtree:undivided=x")->tree_hash(),
            build(scene, "quadtree:undivided=y")->tree_hash());
}

/// A thin plate of tiles, each of which fills a leaf of its own: were z divided, too, each would be
/// in two.
TEST(Quadtree, DividesAFlatSceneOnlyWhereItIsWide) {
  std::vector<Triangle> tiles;
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 16; ++j) {
      const Vec3d at{1.0 * i, 1.0 * j, 0.0};
      tiles.push_back(
          {at + Vec3d{0.2, 0.2, 0}, at + Vec3d{0.8, 0.2, 0}, at + Vec3d{0.2, 0.8, 0.01}});
    }
  const ScenePtr scene = triangles(tiles);
  const auto quad = build(scene, "quadtree:max_prims=1,split=middle");
  EXPECT_EQ(quad->report().leaves, 256u);
  EXPECT_EQ(quad->report().references, 256u);
  EXPECT_EQ(quad->report().depth, 4u);
  EXPECT_GE(build(scene, "octree:max_prims=1,split=middle")->report().references, 512u);
}

}  // namespace
}  // namespace strahl
