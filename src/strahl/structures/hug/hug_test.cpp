#include <algorithm>
#include <cmath>
#include <set>
#include <tests/support/against_brute.h>
#include <tests/support/boxes.h>
#include <tests/support/doctored.h>
#include <tests/support/mesh_maker.h>

#include <strahl/structures/hug/box_clusters.h>
#include <strahl/structures/hug/hug.h>
#include <strahl/structures/hug/hug_plan.h>
#include <strahl/structures/hug/size_groups.h>

namespace strahl {
namespace {

using test::cube;
using test::Doctored;
using test::expect_same_answers;
using test::MeshMaker;
using test::rays_through;
using test::refs_of;
using test::ScenePtr;
using test::soup;
using test::work_of;

TEST(SizeGroups, TellSizesApart) {
  std::vector<Aabb> boxes;
  for (int i = 0; i < 30; ++i)
    boxes.push_back(cube({1.0 * i, 0, 0}, i % 3 == 0 ? 1 : i % 3 == 1 ? 30 : 1000));
  const SizeGroups three = find_size_groups(refs_of(boxes), 3, 4.0);
  ASSERT_EQ(three.mean.size(), 3u);
  for (std::size_t i = 0; i < boxes.size(); ++i) EXPECT_EQ(three.group_of[i], i % 3);
  EXPECT_NEAR(three.mean[1] / three.mean[0], 30.0, 1.0);
  EXPECT_EQ(find_size_groups(refs_of(boxes), 5, 4.0).mean.size(), 3u);
  EXPECT_EQ(find_size_groups(refs_of(boxes), 2, 4.0).mean.size(), 2u);
  EXPECT_EQ(find_size_groups(refs_of(boxes), 3, 32.0).mean.size(), 2u);
  EXPECT_EQ(find_size_groups(refs_of(boxes), 1, 1.0).mean.size(), 1u);
}

TEST(SizeGroups, AGapComesBeforeWhatIsFrequent) {
  std::vector<Aabb> boxes{cube({}, 100)};  // a floor under balls that are smaller and more, again
  for (int level = 0, count = 1; level < 5; ++level, count *= 5)
    for (int i = 0; i < count; ++i) boxes.push_back(cube({}, std::pow(0.4, level)));
  const SizeGroups two = find_size_groups(refs_of(boxes), 2, 4.0);
  ASSERT_EQ(two.mean.size(), 2u);
  for (std::size_t i = 0; i < boxes.size(); ++i) EXPECT_EQ(two.group_of[i], i == 0);
  EXPECT_EQ(find_size_groups(refs_of(boxes), 3, 4.0).mean.size(), 3u);
}

TEST(SizeGroups, OfLikeOrAbsurdSizesAreStillGroups) {
  const std::vector<Aabb> like(10, cube({}, 2)), points(3, cube({1, 1, 1}, 0));
  EXPECT_EQ(find_size_groups(refs_of(like), 4, 1.0).mean.size(), 1u);
  EXPECT_EQ(find_size_groups({}, 4, 1.0).mean.size(), 1u);
  EXPECT_EQ(find_size_groups(refs_of(points), 4, 4.0).mean.size(), 1u);
  const std::vector<Aabb> far{cube({}, 0), cube({}, 0x1p-240), cube({}, 1), cube({}, 0x1p240)};
  EXPECT_EQ(find_size_groups(refs_of(far), 8, 4.0).mean.size(), 4u);
}

TEST(BoxClusters, AreConnectedSets) {
  std::vector<Aabb> boxes;
  for (const double x : {0.0, 1.0, 2.0, 3.5, 4.5, 10.0}) boxes.push_back(cube({x, 0, 0}, 1));
  boxes.push_back(cube({2, 1, 1}, 1));  // touches only corners and edges
  using Sets = std::vector<std::vector<std::uint32_t>>;
  const auto clusters = [&](double distance) {
    return find_clusters(refs_of(boxes), distance, {});
  };
  EXPECT_EQ(clusters(0.0), (Sets{{0, 1, 2, 6}, {3, 4}, {5}}));
  EXPECT_EQ(clusters(0.5), (Sets{{0, 1, 2, 3, 4, 6}, {5}}));
  EXPECT_EQ(clusters(-0.01), (Sets{{0}, {1}, {2}, {3}, {4}, {5}, {6}}));
  EXPECT_EQ(clusters(-100.0).size(), 7u);
  EXPECT_EQ(clusters(100.0).size(), 1u);
}

TEST(BoxClusters, AgreeWithAllPairs) {
  Rng rng(1);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 400; ++i)
    boxes.push_back(cube(test::point_in(cube({}, 1), rng), rng.uniform(0.0, 0.12)));
  std::vector<std::uint32_t> label(boxes.size());
  for (std::uint32_t i = 0; i < label.size(); ++i) label[i] = i;
  for (bool changes = true; changes;) {
    changes = false;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (boxes[i].overlaps(boxes[j]) && label[i] != label[j])
          label[i] = label[j] = std::min(label[i], label[j]), changes = true;
  }
  const auto clusters = find_clusters(refs_of(boxes), 0.0, {});
  ASSERT_GT(clusters.size(), 5u);
  EXPECT_EQ(clusters.size(), std::set<std::uint32_t>(label.begin(), label.end()).size());
  for (const auto& cluster : clusters)
    for (const std::uint32_t i : cluster) EXPECT_EQ(label[i], cluster.front());
}

TEST(BoxClusters, OfCoincidentBoxesAreFoundFast) {
  const std::vector<Aabb> boxes(50000, cube({1, 2, 3}, 4));  // quadratic, this would take minutes
  EXPECT_EQ(find_clusters(refs_of(boxes), 0.0, {}).size(), 1u);
}

TEST(HugPlan, PutsGridsIntoTheSmallestCoarserGridAroundThem) {
  std::vector<Aabb> boxes{cube({0, 0, 0}, 1000)};
  for (int i = 0; i < 10; ++i) boxes.push_back(cube({20.0 * i, 0, 0}, 30));  // 1..10: one cluster
  for (int i = 0; i < 10; ++i) boxes.push_back(cube({50 + 0.5 * i, 5, 5}, 1));     // in it
  for (int i = 0; i < 10; ++i) boxes.push_back(cube({500, 500 + 0.5 * i, 5}, 1));  // beside it
  boxes.push_back(cube({100, 10, 10}, 1));  // 31, alone within it
  boxes.push_back(cube({600, 10, 10}, 1));  // 32, alone
  const std::vector<HugPlan> plans = plan_hug(refs_of(boxes), {3, 4.0, 0.0, 8}, {});
  ASSERT_EQ(plans.size(), 4u);
  const auto entries = [&](std::size_t plan) {
    std::vector<std::uint32_t> list;
    for (const PrimRef& ref : plans[plan].refs) list.push_back(ref.reference);
    return list;
  };
  constexpr std::uint32_t kGrid = NestedGrids::kGridEntry;
  EXPECT_EQ(entries(0), (std::vector<std::uint32_t>{0, 32, kGrid | 2, kGrid | 3}));
  EXPECT_EQ(entries(3), (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 31, kGrid | 1}));
  EXPECT_EQ(plans[1].refs.size(), 10u);
  EXPECT_EQ(plan_hug(refs_of(boxes), {3, 4.0, 0.0, 11}, {}).size(), 1u);
  EXPECT_EQ(plan_hug(refs_of(boxes), {1, 4.0, 0.0, 1}, {}).size(), 1u);
}

/// Tiny dust in lumps on small things in a room of large triangles.
MeshMaker lumps(int count) {
  MeshMaker mesh = soup(40, 0.6, 2);
  Rng rng(3);
  for (int i = 0; i < count; ++i) {
    const Vec3d at = test::point_in(cube({}, 1), rng);
    const double sizes[] = {0.02, 0.0005};
    for (const double size : sizes) {
      const MeshMaker part = soup(60, 0.4, static_cast<std::uint64_t>(10 + i));
      for (std::size_t k = 0; k < part.vertices.size(); k += 3)
        mesh.triangle(at + size * part.vertices[k], at + size * part.vertices[k + 1],
                      at + size * part.vertices[k + 2]);
    }
  }
  return mesh;
}

TEST(Hug, FindsHitsThroughGridsInGrids) {
  const MeshMaker mesh = lumps(12);
  const ScenePtr scene = mesh.scene();
  ASSERT_EQ(build(scene, "hug")->report().depth, 2u);
  const std::vector<Ray> rays = rays_through(mesh.vertices, scene->total_bounds(), 60, 4);
  for (const char* more : {"", ":exact=off", ":mailbox=off", ":groups=2", ":connectivity=0.5"})
    expect_same_answers(scene, rays, std::string("hug") + more);
}

TEST(Hug, FindsHitsInPlanesOfCellsAndBoxes) {
  // Rooms of rooms: walls lie in sides of boxes of clusters and in planes between cells.
  MeshMaker mesh = test::walls(4, 1.0, {});
  for (const double x : {0.25, 2.0}) {
    const MeshMaker small = test::walls(4, 0.0625, {x, 1.0, 1.0});
    for (std::size_t k = 0; k < small.vertices.size(); k += 3)
      mesh.triangle(small.vertices[k], small.vertices[k + 1], small.vertices[k + 2]);
  }
  const ScenePtr scene = mesh.scene();
  ASSERT_EQ(build(scene, "hug")->report().depth, 1u);
  const std::vector<Ray> rays = rays_through(mesh.vertices, scene->total_bounds(), 60, 5);
  for (const char* more : {"", ",density=0.5", ",exact=off,mailbox=off"})
    expect_same_answers(scene, rays, std::string("hug:groups=2") + more);
}

TEST(Hug, EntersEachGridOncePerRay) {
  const ScenePtr scene = lumps(12).scene();
  const Hug hug(*scene, {}, {});
  ASSERT_GT(hug.grids().grids.size(), 2u);
  // A ray through all cells of the outermost grid that list a grid offers each hit once.
  std::vector<Ray> rays;
  for (std::uint32_t grid = 1; grid < hug.grids().grids.size(); ++grid) {
    const Vec3d middle = hug.grids().box(grid).center();
    rays.push_back({middle - Vec3d{3, 0.01, 0.02}, {3, 0.01, 0.02}});
  }
  const Counters once = work_of(*build(scene, "hug"), rays);
  const Counters coarse = work_of(*build(scene, "hug:resolution=fixed,nx=1,ny=1,nz=1"), rays);
  // With one outer cell no grid can be met twice; with many, steps in inner grids are as few.
  const std::uint64_t outer_cells = 3u * 64 * rays.size();
  EXPECT_LE(once.traversal_steps, coarse.traversal_steps + outer_cells);
  EXPECT_LE(once.primitives, coarse.primitives);
}

TEST(Hug, IsAGridWhereAllAreOfASize) {
  const ScenePtr scene = soup(500, 0.05, 6).scene();
  const BuildReport hug = build(scene, "hug")->report(), grid = build(scene, "grid")->report();
  EXPECT_EQ(hug.references, grid.references);
  EXPECT_EQ(hug.leaves, grid.leaves);
}

TEST(Hug, SavesTestsWhereSizesDiffer) {
  const ScenePtr scene = lumps(12).scene();
  Rng rng(7);
  std::vector<Ray> rays;
  for (int i = 0; i < 500; ++i) {
    const Vec3d target = scene->bounds(100 + rng.below(scene->size() - 100)).center();
    const Vec3d org = test::point_in(cube({}, 1), rng);
    rays.push_back({org, target - org});
  }
  EXPECT_LT(3 * work_of(*build(scene, "hug"), rays).primitives,
            work_of(*build(scene, "grid"), rays).primitives);
}

TEST(Hug, HonoursMemoryLimitAndCancelling) {
  const ScenePtr scene = lumps(10).scene();
  BuildContext limited;
  limited.memory_limit = build(scene, "hug")->report().bytes;
  EXPECT_THROW(build(scene, "hug", limited), Error);
  for (const char* at : {"clustering", "filling grids"}) {
    BuildContext cancelled;
    cancelled.progress = [at](double, std::string_view stage) { return stage != at; };
    EXPECT_THROW(build(scene, "hug", cancelled), Error) << at;
  }
}

TEST(Hug, OfNothingHitsNothing) {
  const ScenePtr scene = MeshMaker{}.scene();
  const auto hug = build(scene, "hug");
  ASSERT_NO_THROW(hug->validate());
  EXPECT_FALSE(test::closest_hits(*hug, make_batch(std::vector<Ray>{{{}, {1, 0, 0}}}))[0].is_hit());
}

TEST(Hug, ValidateNoticesWhatIsMissingOrTooMuch) {
  const ScenePtr scene = lumps(4).scene();
  const Hug hug(*scene, {}, {});
  ASSERT_NO_THROW(hug.validate(*scene));
  for (const std::uint32_t at : {3u, 60u, 130u}) {  // in grids of each group
    const auto refuses = [&](auto change) {
      EXPECT_THROW(hug.validate(Doctored(*scene, change)), std::logic_error) << at;
    };
    refuses([at](std::uint32_t i, Aabb box) { return i == at ? Aabb{} : box; });
    refuses([at](std::uint32_t i, Aabb box) {
      return i == at ? Aabb{box.hi + Vec3d::all(0.1), box.hi + Vec3d::all(0.1)} : box;
    });
    const Hug fewer(
        Doctored(*scene, [at](std::uint32_t i, Aabb b) { return i == at ? Aabb{} : b; }), {}, {});
    EXPECT_THROW(fewer.validate(*scene), std::logic_error);
  }
}

}  // namespace
}  // namespace strahl
