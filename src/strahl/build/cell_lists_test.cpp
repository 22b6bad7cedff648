#include <algorithm>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/build/cell_lists.h>
#include <strahl/geometry/scene.h>

namespace strahl {
namespace {

/// Triangles anywhere, many with corners on planes between cells.
Scene make_scene(const UniformCells& cells, int count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (int i = 0; i < 3 * count; ++i) {
    Vec3d v;
    for (int a = 0; a < 3; ++a) {
      const auto planes = static_cast<std::uint32_t>(cells.n(a)) + 1;
      const double lo = cells.plane(a, 0), hi = cells.plane(a, cells.n(a));
      v[a] = rng.below(2) ? cells.plane(a, static_cast<int>(rng.below(planes)))
                          : lo + rng.uniform() * (hi - lo);
    }
    indices.push_back(static_cast<std::uint32_t>(vertices.size()));
    vertices.push_back(v);
  }
  Geometry geometry;
  geometry.mesh = make_mesh(std::move(vertices), std::move(indices));
  SceneData data;
  data.geometries.push_back(std::move(geometry));
  return Scene(std::move(data));
}

template <class Visit>
void for_cells(const UniformCells& cells, Visit visit) {
  for (int z = 0; z < cells.n(2); ++z)
    for (int y = 0; y < cells.n(1); ++y)
      for (int x = 0; x < cells.n(0); ++x) visit(CellPosition{x, y, z});
}

bool lists(const CellLists& all, std::size_t cell, std::uint32_t reference) {
  const auto list = all[cell];
  return std::find(list.begin(), list.end(), reference) != list.end();
}

class CellListsOfTriangles : public testing::Test {
 protected:
  UniformCells cells{{{-1, 0, 10}, {1, 3, 11}}, {5, 7, 4}};
  Scene scene = make_scene(cells, 120, 1);
  std::vector<PrimRef> refs = make_prim_refs(scene, {});

  CellLists make(bool exact) const { return *make_cell_lists(cells, {scene, refs, exact}, 0, {}); }
};

TEST_F(CellListsOfTriangles, HoldEveryBoxInEveryClosedCellItTouches) {
  const CellLists all = make(false);
  ASSERT_EQ(all.first.size(), cells.count() + 1);
  for_cells(cells, [&](const CellPosition& at) {
    std::vector<std::uint32_t> expected;
    for (const PrimRef& ref : refs)
      if (ref.box.overlaps(cells.box(at))) expected.push_back(ref.reference);
    const auto list = all[cells.index(at)];
    ASSERT_EQ(std::vector<std::uint32_t>(list.begin(), list.end()), expected);
  });
}

TEST_F(CellListsOfTriangles, ExactOnesHoldEveryPointOfATriangleInItsClosedCells) {
  const CellLists all = make(true);
  Rng rng(2);
  for (const PrimRef& ref : refs) {
    const TriangleVertices t = scene.geometries()[0].mesh[ref.reference];
    for (const Vec3d& corner : {t.a, t.b, t.c})
      for_cells(cells, [&](const CellPosition& at) {
        const bool must = cells.box(at).contains(corner);
        ASSERT_TRUE(!must || lists(all, cells.index(at), ref.reference));
      });
    for (int i = 0; i < 200; ++i) {
      const double u = rng.uniform(), v = rng.uniform() * (1 - u);
      const Vec3d p = (1 - u - v) * t.a + u * t.b + v * t.c;
      const CellPosition at{cells.guess(0, p.x), cells.guess(1, p.y), cells.guess(2, p.z)};
      ASSERT_TRUE(lists(all, cells.index(at), ref.reference));
    }
  }
}

TEST_F(CellListsOfTriangles, ExactOnesHoldNothingThatIsClearlyElsewhere) {
  const CellLists all = make(true);
  std::size_t saved = 0;
  for_cells(cells, [&](const CellPosition& at) {
    Aabb wide = cells.box(at);
    wide.lo = wide.lo - Vec3d::all(1e-12), wide.hi = wide.hi + Vec3d::all(1e-12);
    for (const PrimRef& ref : refs) {
      const bool is_listed = lists(all, cells.index(at), ref.reference);
      ASSERT_FALSE(is_listed && scene.clip(ref.reference, wide).is_empty());
      saved += !is_listed && ref.box.overlaps(wide);
    }
  });
  EXPECT_GT(saved, all.references.size() / 2);
}

TEST_F(CellListsOfTriangles, StopAtTheMostReferences) {
  const std::uint64_t total = make(true).references.size();
  EXPECT_TRUE(make_cell_lists(cells, {scene, refs, true, total}, 0, {}));
  EXPECT_FALSE(make_cell_lists(cells, {scene, refs, true, total - 1}, 0, {}));
}

TEST_F(CellListsOfTriangles, RequireTheirMemoryBeforeTheyTakeIt) {
  BuildContext tight;
  const std::uint64_t total = make(true).references.size();
  // Lists, what is remembered of each primitive, and found cells, for which room grows by halves.
  const std::uint64_t least = 4 * (cells.count() + 1 + refs.size() + 2 * total);
  tight.memory_limit = 100 + least + 4 * total;
  EXPECT_NO_THROW(make_cell_lists(cells, {scene, refs, true}, 100, tight));
  EXPECT_THROW(make_cell_lists(cells, {scene, refs, true}, 101 + 4 * total, tight), Error);
  tight.memory_limit = 4 * cells.count();
  EXPECT_THROW(make_cell_lists(cells, {scene, refs, true}, 0, tight), Error);
}

TEST_F(CellListsOfTriangles, CanBeCancelledInBothPasses) {
  for (const double at : {0.0, 0.5}) {
    BuildContext context;
    context.progress = [=](double fraction, std::string_view) { return fraction < at; };
    EXPECT_THROW(make_cell_lists(cells, {scene, refs, true}, 0, context), Error);
  }
}

}  // namespace
}  // namespace strahl
