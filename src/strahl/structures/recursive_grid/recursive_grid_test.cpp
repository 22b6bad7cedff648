#include <cmath>
#include <tests/support/against_brute.h>
#include <tests/support/doctored.h>
#include <tests/support/mesh_maker.h>

#include <strahl/structures/recursive_grid/recursive_grid.h>

namespace strahl {
namespace {

using test::Doctored;
using test::expect_same_answers;
using test::MeshMaker;
using test::rays_through;
using test::ScenePtr;
using test::soup;
using test::work_of;

constexpr const char* kFixed =
    "recursive_grid:resolution=fixed,nx=4,ny=4,nz=4,sub_resolution=fixed,sub_n=4,max_prims=1,"
    "decide=always,max_growth=100000";

/// Walls in the planes of the cells, one pair of triangles per side.
void add_walls(const UniformCells& cells, const Aabb& within, MeshMaker& mesh) {
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i <= cells.n(axis); ++i)
      for (int j = 0; j < cells.n((axis + 1) % 3); ++j)
        for (int k = 0; k < cells.n((axis + 2) % 3); ++k) {
          const int u = (axis + 1) % 3, v = (axis + 2) % 3;
          const auto corner = [&](int dj, int dk) {
            Vec3d p;
            p[axis] = cells.plane(axis, i), p[u] = cells.plane(u, j + dj);
            p[v] = cells.plane(v, k + dk);
            return min(p, within.hi);
          };
          mesh.triangle(corner(0, 0), corner(1, 0), corner(1, 1));
          if ((i + j + k) % 3 != 0) mesh.triangle(corner(0, 0), corner(1, 1), corner(0, 1));
        }
}

/// Walls in all planes of the outermost grid, of a sub-grid and of one in that.
MeshMaker walls_at_all_levels() {
  const Aabb box{{-1, -1, -1}, {2, 2.5, 2}};
  MeshMaker mesh;
  const UniformCells outer(box, {4, 4, 4});
  add_walls(outer, box, mesh);
  const Aabb cell = outer.box({1, 2, 1});
  const UniformCells inner(cell, {4, 4, 4});
  add_walls(inner, cell, mesh);
  const Aabb small = inner.box({3, 0, 2});
  add_walls(UniformCells(small, {4, 4, 4}), small, mesh);
  return mesh;
}

TEST(RecursiveGrid, FindsHitsInPlanesAndOnEdgesOfCellsAtAllLevels) {
  const MeshMaker mesh = walls_at_all_levels();
  const ScenePtr scene = mesh.scene();
  ASSERT_EQ(build(scene, kFixed)->report().depth, 2u);
  const std::vector<Ray> rays = rays_through(mesh.vertices, scene->total_bounds(), 30, 1);
  const std::vector<Vec3d> small(mesh.vertices.end() - 300, mesh.vertices.end());
  const std::vector<Ray> close = rays_through(small, {small.front(), small.back()}, 30, 2);
  for (const char* more : {"", ",exact=off", ",mailbox=off", ",max_depth=2"}) {
    expect_same_answers(scene, rays, std::string(kFixed) + more);
    expect_same_answers(scene, close, std::string(kFixed) + more);
  }
}

/// Fine dust in a corner of large triangles.
ScenePtr dust_and_sheets(std::size_t dust, double size) {
  MeshMaker mesh = soup(dust, 0.01, 3);
  for (Vec3d& v : mesh.vertices) v = size * v;
  const MeshMaker sheets = soup(100, 0.3, 4);
  for (std::size_t i = 0; i + 2 < sheets.vertices.size(); i += 3)
    mesh.triangle(sheets.vertices[i], sheets.vertices[i + 1], sheets.vertices[i + 2]);
  return mesh.scene();
}

TEST(RecursiveGrid, FindsHitsFromAnyDistance) {
  const ScenePtr scene = dust_and_sheets(400, 0.02);
  Rng rng(5);
  for (const double distance : {1e3, 1e9, 1e14}) {
    std::vector<Ray> rays;
    for (int i = 0; i < 15; ++i) {
      const Vec3d target = scene->bounds(rng.below(scene->size())).center();
      const Vec3d dir = test::point_in({Vec3d::all(-1), Vec3d::all(1)}, rng);
      const Vec3d org = target - distance * dir;
      rays.push_back({org, dir}), rays.push_back({org, target - org});
    }
    expect_same_answers(scene, rays, "recursive_grid");
  }
}

TEST(RecursiveGrid, FindsHitsOfInstances) {
  SceneData data;
  data.geometries.push_back(walls_at_all_levels().geometry());
  const Affine turned = Affine::translation({1e3, -2e3, 5e2}) * Affine::scaling({3.0, 0.01, 1.0}) *
                        Affine::rotation(0.1, 0.2, 0.3, std::sqrt(1 - 0.14));
  data.instances = {{0, 1, turned, 0}, {0, 1, Affine::translation({1e3, -2e3, 505}), 1}};
  const auto scene = std::make_shared<const Scene>(std::move(data));
  std::vector<Vec3d> points;
  for (std::uint32_t i = 0; i < scene->size(); ++i) points.push_back(scene->bounds(i).lo);
  const std::vector<Ray> rays = rays_through(points, scene->total_bounds(), 60, 6);
  expect_same_answers(scene, rays, "recursive_grid:max_prims=2,decide=always");
}

TEST(RecursiveGrid, SubGridsSaveTests) {
  const ScenePtr scene = dust_and_sheets(3000, 0.02);
  Rng rng(7);
  std::vector<Ray> rays;
  for (int i = 0; i < 500; ++i) {
    const Vec3d target = test::point_in({{}, Vec3d::all(0.02)}, rng);
    rays.push_back({test::point_in({{}, Vec3d::all(1)}, rng), {}});
    rays.back().dir = target - rays.back().org;
  }
  const Counters flat = work_of(*build(scene, "recursive_grid:max_depth=1"), rays);
  const Counters nested = work_of(*build(scene, "recursive_grid"), rays);
  EXPECT_EQ(flat.primitives, work_of(*build(scene, "grid"), rays).primitives);
  EXPECT_LT(20 * nested.primitives, flat.primitives);
  EXPECT_LT(nested.leaves, nested.traversal_steps);
  EXPECT_EQ(flat.leaves, flat.traversal_steps);
}

TEST(RecursiveGrid, CountsAnswersButNotRepeatedTests) {
  const ScenePtr scene = soup(2000, 0.2, 9).scene();
  const std::vector<Ray> rays =
      rays_through(soup(100, 0.2, 9).vertices, scene->total_bounds(), 60, 10);
  const auto tests = [&](const char* spec) {
    return work_of(*build(scene, spec), rays).primitives;
  };
  EXPECT_LT(tests("recursive_grid"), tests("recursive_grid:mailbox=off"));
  EXPECT_LT(tests("recursive_grid"), tests("recursive_grid:exact=off"));
}

TEST(RecursiveGrid, GrowsNoMoreThanAllowed) {
  // Sheets all through each other: every level would multiply them.
  const ScenePtr scene = soup(200, 2.0, 11).scene();
  const auto free = build(scene, "recursive_grid:decide=always,max_depth=3,max_growth=1000000");
  for (const double growth : {0.0, 10.0, 128.0, 500.0}) {
    RecursiveGridOptions options;
    options.decide = NestingDecision::always, options.max_growth = growth;
    const RecursiveGrid grid(*scene, options, {});
    ASSERT_NO_THROW(grid.validate(*scene));
    EXPECT_LT(grid.report().references, free->report().references);
    EXPECT_EQ(grid.report().depth > 0, growth >= 128.0) << growth;
  }
}

TEST(RecursiveGrid, DividesWhereThatPaysUnlessTold) {
  // What crosses the whole cell is met in most cells of a sub-grid, too.
  const ScenePtr sheets = soup(400, 2.0, 11).scene(), dust = dust_and_sheets(400, 0.02);
  const auto cells = [](const ScenePtr& scene, const char* spec) {
    return build(scene, spec)->report().nodes;
  };
  const std::uint64_t flat = cells(sheets, "recursive_grid:max_depth=1");
  EXPECT_LT(cells(sheets, "recursive_grid"), flat + 10);
  EXPECT_GT(cells(sheets, "recursive_grid:decide=always"), flat + 100);
  EXPECT_GT(cells(dust, "recursive_grid"), 2 * cells(dust, "recursive_grid:max_depth=1"));
}

TEST(RecursiveGrid, AnswersAboutCoincidentPrimitives) {
  MeshMaker mesh;
  for (int i = 0; i < 200; ++i) mesh.triangle({0, 0, 0}, {1, 0, 0.5}, {0, 1, 0.5});
  const ScenePtr scene = mesh.scene();
  const std::vector<Ray> rays = rays_through(mesh.vertices, scene->total_bounds(), 20, 12);
  expect_same_answers(scene, rays, "recursive_grid:decide=always");
}

TEST(RecursiveGrid, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const ScenePtr scene = dust_and_sheets(3000, 0.005);
  BuildContext three;
  three.executor = Executor::with_threads(3);
  const auto serial = build(scene, "recursive_grid"),
             parallel = build(scene, "recursive_grid", three);
  ASSERT_GT(serial->report().depth, 1u);
  EXPECT_EQ(serial->tree_hash(), parallel->tree_hash());
  EXPECT_NO_THROW(parallel->validate());
}

TEST(RecursiveGrid, HonoursMemoryLimitAndCancelling) {
  const ScenePtr scene = dust_and_sheets(3000, 0.02);
  const std::uint64_t flat = build(scene, "recursive_grid:max_depth=1")->report().bytes;
  const std::uint64_t nested = build(scene, "recursive_grid")->report().bytes;
  ASSERT_LT(flat, nested);
  BuildContext limited;
  limited.memory_limit = nested;
  EXPECT_THROW(build(scene, "recursive_grid", limited), Error);
  limited.memory_limit = 4 * nested + 3100 * sizeof(PrimRef);
  EXPECT_NO_THROW(build(scene, "recursive_grid", limited));
  BuildContext cancelled;
  cancelled.progress = [](double, std::string_view stage) { return stage != "dividing cells"; };
  EXPECT_THROW(build(scene, "recursive_grid", cancelled), Error);
}

TEST(RecursiveGrid, OfNothingHitsNothing) {
  const ScenePtr scene = MeshMaker{}.scene();
  const auto grid = build(scene, "recursive_grid");
  ASSERT_NO_THROW(grid->validate());
  EXPECT_FALSE(
      test::closest_hits(*grid, make_batch(std::vector<Ray>{{{}, {1, 0, 0}}}))[0].is_hit());
}

TEST(RecursiveGrid, ValidateNoticesWhatIsMissingOrTooMuch) {
  const ScenePtr scene = dust_and_sheets(200, 0.1);
  for (const bool exact : {false, true}) {
    RecursiveGridOptions options;
    options.exact = exact, options.decide = NestingDecision::always, options.max_prims = 2;
    const RecursiveGrid grid(*scene, options, {});
    ASSERT_GT(grid.report().depth, 0u);
    ASSERT_NO_THROW(grid.validate(*scene));
    const auto refuses = [&](auto change) {
      EXPECT_THROW(grid.validate(Doctored(*scene, change)), std::logic_error);
    };
    for (const std::uint32_t at : {7u, 250u}) {  // deep in sub-grids, and across cells
      refuses([at](std::uint32_t i, Aabb box) { return i == at ? Aabb{} : box; });
      refuses([at](std::uint32_t i, Aabb box) {
        return i == at ? Aabb{box.hi + Vec3d::all(0.2), box.hi + Vec3d::all(0.2)} : box;
      });
      const RecursiveGrid fewer(
          Doctored(*scene, [at](std::uint32_t i, Aabb b) { return i == at ? Aabb{} : b; }), options,
          {});
      EXPECT_THROW(fewer.validate(*scene), std::logic_error);
    }
  }
}

}  // namespace
}  // namespace strahl
