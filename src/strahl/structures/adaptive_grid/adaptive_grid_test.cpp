#include <algorithm>
#include <tests/support/against_brute.h>
#include <tests/support/boxes.h>
#include <tests/support/doctored.h>
#include <tests/support/mesh_maker.h>

#include <strahl/structures/adaptive_grid/adaptive_grid.h>
#include <strahl/structures/adaptive_grid/agglomerate.h>

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

std::vector<std::vector<std::uint32_t>> members(const std::vector<Cluster>& clusters) {
  std::vector<std::vector<std::uint32_t>> sets;
  for (const Cluster& cluster : clusters) {
    sets.emplace_back();
    for (const PrimRef& ref : cluster.refs) sets.back().push_back(ref.reference);
  }
  std::sort(sets.begin(), sets.end());
  return sets;
}

TEST(Agglomerate, JoinsWhatStaysTight) {
  using Sets = std::vector<std::vector<std::uint32_t>>;
  // Unit cubes with a gap g: the joint box has 5 + 2g times the area of a side, both have 6.
  const auto pair = [](double gap, double f) {
    return members(agglomerate(refs_of({cube({}, 1), cube({1 + gap, 0, 0}, 1)}), {f, 1000}, {}));
  };
  EXPECT_EQ(pair(0.0, 0.83), (Sets{{0}, {1}}));
  EXPECT_EQ(pair(0.0, 0.84), (Sets{{0, 1}}));
  EXPECT_EQ(pair(1.9, 1.5), (Sets{{0, 1}}));
  EXPECT_EQ(pair(2.1, 1.5), (Sets{{0}, {1}}));
  const std::vector<PrimRef> row =
      refs_of({cube({0, 0, 0}, 1), cube({1, 0, 0}, 1), cube({50, 0, 0}, 1), cube({51, 0, 0}, 1)});
  EXPECT_EQ(members(agglomerate(row, {1.5, 1000}, {})), (Sets{{0, 1}, {2, 3}}));
  EXPECT_EQ(members(agglomerate(row, {1.5, 0.0}, {})), (Sets{{0}, {1}, {2}, {3}}));
  EXPECT_EQ(members(agglomerate(row, {1000, 1000}, {})), (Sets{{0, 1, 2, 3}}));
}

TEST(Agglomerate, KeepsAreasBelowThePartAndEveryPrimitiveOnce) {
  Rng rng(1);
  std::vector<Aabb> boxes;
  Aabb all;
  for (int i = 0; i < 3000; ++i) {
    boxes.push_back(cube(test::point_in(cube({}, 1), rng), rng.uniform(0.0, 0.05)));
    all.extend(boxes.back());
  }
  const std::vector<Cluster> clusters = agglomerate(refs_of(boxes), {1.5, 0.05}, {});
  EXPECT_LT(clusters.size(), 1000u);
  std::vector<std::uint32_t> seen;
  for (const Cluster& cluster : clusters) {
    EXPECT_LT(cluster.box.half_area(), 0.05 * all.half_area());
    for (const PrimRef& ref : cluster.refs) {
      EXPECT_TRUE(cluster.box.contains(ref.box));
      seen.push_back(ref.reference);
    }
  }
  std::sort(seen.begin(), seen.end());
  ASSERT_EQ(seen.size(), boxes.size());
  for (std::uint32_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], i);
}

TEST(Agglomerate, RowsOfEqualBoxesAreJoinedInFewRounds) {
  std::vector<Aabb> same(50000, cube({1, 1, 1}, 2));
  int rounds = 0;
  BuildContext counting;
  counting.progress = [&](double, std::string_view stage) {
    rounds += stage == "joining clusters";
    return true;
  };
  EXPECT_EQ(agglomerate(refs_of(same), {1.5, 2.0}, counting).size(), 1u);
  EXPECT_LE(rounds, 20);
}

TEST(Agglomerate, DoesNotDependOnThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  Rng rng(2);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 3000; ++i) boxes.push_back(cube(test::point_in(cube({}, 1), rng), 0.01));
  BuildContext three;
  three.executor = Executor::with_threads(3);
  EXPECT_EQ(members(agglomerate(refs_of(boxes), {1.5, 0.1}, {})),
            members(agglomerate(refs_of(boxes), {1.5, 0.1}, three)));
}

/// Lumps of fine triangles far apart, and single ones between them.
MeshMaker lumps() {
  MeshMaker mesh;
  Rng rng(3);
  for (int i = 0; i < 20; ++i) {
    const Vec3d at = test::point_in(cube({}, 100), rng);
    const MeshMaker part = soup(60, 0.1, static_cast<std::uint64_t>(10 + i));
    for (std::size_t k = 0; k < part.vertices.size(); k += 3)
      mesh.triangle(at + part.vertices[k], at + part.vertices[k + 1], at + part.vertices[k + 2]);
    const Vec3d alone = test::point_in(cube({}, 100), rng);
    mesh.triangle(alone, alone + Vec3d{3, 0, 1}, alone + Vec3d{0, 3, 1});
  }
  return mesh;
}

TEST(AdaptiveGrid, FindsHitsInClustersAndOrphans) {
  const MeshMaker mesh = lumps();
  const ScenePtr scene = mesh.scene();
  const std::vector<Ray> rays = rays_through(mesh.vertices, scene->total_bounds(), 60, 4);
  for (const char* more : {"", ":orphans=grid", ":exact=off", ":mailbox=off", ":f=1,min_cluster=1",
                           ":max_depth=3,max_prims=1,decide=always", ":f=1000,m=1000"})
    expect_same_answers(scene, rays, std::string("adaptive_grid") + more);
}

TEST(AdaptiveGrid, FindsHitsInSidesOfClustersAndCells) {
  const MeshMaker mesh = test::walls(6, 1.0, {0.1, 0.2, 0.3});
  const ScenePtr scene = mesh.scene();
  const std::vector<Ray> rays = rays_through(mesh.vertices, scene->total_bounds(), 60, 5);
  for (const char* more : {"", ",density=1", ",max_depth=2,max_prims=1,decide=always"})
    expect_same_answers(scene, rays, std::string("adaptive_grid:m=0.2") + more);
}

TEST(AdaptiveGrid, MakesAGridPerClusterAndLeavesOfOrphans) {
  const ScenePtr scene = lumps().scene();
  const AdaptiveGrid made(*scene, {}, {});
  EXPECT_EQ(made.grids().grids.size(), 20u);
  AdaptiveGridOptions options;
  options.orphans = OrphanPlace::grid;
  EXPECT_EQ(AdaptiveGrid(*scene, options, {}).grids().grids.size(), 21u);
  options.min_cluster = 1000;
  EXPECT_EQ(AdaptiveGrid(*scene, options, {}).grids().grids.size(), 1u);
  options.orphans = OrphanPlace::tree;
  const AdaptiveGrid tree(*scene, options, {});
  EXPECT_EQ(tree.grids().grids.size(), 0u);
  EXPECT_EQ(tree.report().leaves, scene->size());
  EXPECT_EQ(tree.report().references, scene->size());
}

TEST(AdaptiveGrid, SavesStepsBetweenClusters) {
  const MeshMaker mesh = lumps();
  const ScenePtr scene = mesh.scene();
  const std::vector<Ray> rays = rays_through(mesh.vertices, scene->total_bounds(), 60, 6);
  const Counters clusters = work_of(*build(scene, "adaptive_grid"), rays);
  const Counters grid = work_of(*build(scene, "grid"), rays);
  EXPECT_LT(clusters.traversal_steps, grid.traversal_steps);
  EXPECT_LT(2 * clusters.primitives, grid.primitives);
  EXPECT_GT(clusters.bounding_volumes, 0u);
}

TEST(AdaptiveGrid, HonoursMemoryLimitAndCancelling) {
  const ScenePtr scene = lumps().scene();
  BuildContext limited;
  limited.memory_limit = build(scene, "adaptive_grid")->report().bytes;
  EXPECT_THROW(build(scene, "adaptive_grid", limited), Error);
  for (const char* at : {"joining clusters", "filling grids"}) {
    BuildContext cancelled;
    cancelled.progress = [at](double, std::string_view stage) { return stage != at; };
    EXPECT_THROW(build(scene, "adaptive_grid", cancelled), Error) << at;
  }
}

TEST(AdaptiveGrid, OfNothingHitsNothing) {
  const ScenePtr scene = MeshMaker{}.scene();
  const auto made = build(scene, "adaptive_grid");
  ASSERT_NO_THROW(made->validate());
  EXPECT_FALSE(
      test::closest_hits(*made, make_batch(std::vector<Ray>{{{}, {1, 0, 0}}}))[0].is_hit());
}

TEST(AdaptiveGrid, ValidateNoticesWhatIsMissingOrTooMuch) {
  const ScenePtr scene = lumps().scene();
  const AdaptiveGrid made(*scene, {}, {});
  ASSERT_NO_THROW(made.validate(*scene));
  for (const std::uint32_t at : {30u, 60u}) {  // in a cluster, and an orphan
    const auto refuses = [&](auto change) {
      EXPECT_THROW(made.validate(Doctored(*scene, change)), std::logic_error) << at;
    };
    refuses([at](std::uint32_t i, Aabb box) { return i == at ? Aabb{} : box; });
    refuses([at](std::uint32_t i, Aabb box) {
      return i == at ? Aabb{box.lo, box.hi + Vec3d::all(1)} : box;
    });
    const AdaptiveGrid fewer(
        Doctored(*scene, [at](std::uint32_t i, Aabb b) { return i == at ? Aabb{} : b; }), {}, {});
    EXPECT_THROW(fewer.validate(*scene), std::logic_error);
  }
}

}  // namespace
}  // namespace strahl
