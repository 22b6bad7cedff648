// Ties: of hits with the same t the lowest (instance, geometry, primitive) id comes first, whatever
// the order in which things are stored, and nothing is lost at equal t.
#include <algorithm>
#include <string>
#include <tests/numeric/solids.h>
#include <tests/support/queries.h>

#include <gtest/gtest.h>

namespace strahl::test {
namespace {

TriangleMesh copies(std::uint32_t count) {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < count; ++i) indices.insert(indices.end(), {0, 1, 2});
  return make_mesh(std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5}}, std::move(indices));
}

const Ray kDown{{0.25, 0.25, 2}, {0, 0, -1}};

std::vector<PrimitiveId> ids_of(std::span<const Hit> hits) {
  std::vector<PrimitiveId> ids;
  for (const Hit& hit : hits) ids.push_back(hit.id);
  return ids;
}

/// One hit of each of the ids at the same t, lowest first, and the lowest one as the closest.
void expect_tie(const std::shared_ptr<const Scene>& scene, std::vector<PrimitiveId> ids) {
  std::sort(ids.begin(), ids.end());
  for (const auto& structure : build_all(scene)) {
    SCOPED_TRACE(structure->spec());
    const AllHits all = all_hits(*structure, make_batch({&kDown, 1}));
    EXPECT_EQ(ids_of(all.hits), ids);
    for (const Hit& hit : all.hits) EXPECT_EQ(hit.t, all.hits.front().t);
    EXPECT_EQ(structure->closest_hit(kDown).id, ids.front());
    for (const PrimitiveId& excluded : {ids.front(), ids.back()}) {
      RayBatch batch = make_batch({&kDown, 1});
      batch.excluded = {&excluded, 1};
      EXPECT_EQ(closest_hits(*structure, batch)[0].id,
                ids[excluded == ids.front() && ids.size() > 1 ? 1 : 0]);
    }
  }
}

TEST(Ties, BetweenPrimitivesGoToTheLowestNumber) {
  std::vector<PrimitiveId> ids;
  for (std::uint32_t i = 0; i < 100; ++i) ids.push_back({0, 0, i});
  expect_tie(scene_of(copies(100)), ids);
}

TEST(Ties, BetweenGeometriesAndInstancesGoToTheLowestIdNotTheFirstStored) {
  SceneData data;
  for (const std::uint32_t id : {5u, 3u, 8u}) {
    data.geometries.emplace_back().mesh = copies(2);
    data.geometries.back().geometry_id = id;
  }
  data.instances = {{0, 3, Affine{}, 20},
                    {1, 2, Affine::translation({0, 0, 0}), 10},
                    {2, 1, Affine::scaling({1, 1, 1}), 15}};
  std::vector<PrimitiveId> ids;
  for (const std::uint32_t prim : {0u, 1u}) {
    for (const std::uint32_t geom : {5u, 3u, 8u}) ids.push_back({20, geom, prim});
    for (const std::uint32_t geom : {3u, 8u}) ids.push_back({10, geom, prim});
    ids.push_back({15, 8, prim});
  }
  expect_tie(std::make_shared<const Scene>(std::move(data)), ids);
}

TEST(Ties, AreKeptThroughMapsThatUndoThemselvesExactly) {
  // The same plane from a doubled half-size and from a mirrored mesh.
  const TriangleMesh half =
      make_mesh(std::vector<Vec3f>{{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0.25}}, {0, 1, 2});
  SceneData data;
  data.geometries.emplace_back().mesh = copies(1);
  data.geometries.emplace_back().mesh = half;
  data.geometries.back().geometry_id = 1;
  data.instances = {{0, 1, Affine{}, 3}, {1, 1, Affine::scaling({2, 2, 2}), 2}};
  expect_tie(std::make_shared<const Scene>(std::move(data)), {{3, 0, 0}, {2, 1, 0}});
}

/// Faces of stacked unit cubes coincide in pairs, of neighbouring sheets in fours.
TEST(Ties, OfCoincidentSheetsAreAllListedInTheOrderOfIds) {
  IntegerMesh sheets = integer_cube(2);
  for (int copy = 0; copy < 3; ++copy) {
    const IntegerMesh more = integer_cube(2);
    sheets.insert(sheets.end(), more.begin(), more.end());
  }
  Rng rng(8);
  std::vector<Ray> rays;
  std::vector<std::vector<IntegerHit>> expected;
  while (rays.size() < 3000) {
    Integers org, dir;
    for (std::size_t axis = 0; axis < 3; ++axis)
      org[axis] = std::int64_t{rng.below(9)} - 4, dir[axis] = std::int64_t{rng.below(5)} - 2;
    if (dir == Integers{}) continue;
    rays.push_back({as_vector(org), as_vector(dir)});
    auto& hits = expected.emplace_back(integer_crossings(org, dir, sheets));
    std::erase_if(hits, [](const IntegerHit& h) { return h.t < 0; });
  }
  for (const auto& structure : build_all(scene_of(as_mesh(sheets)))) {
    SCOPED_TRACE(structure->spec());
    const AllHits all = all_hits(*structure, make_batch(rays));
    const std::vector<Hit> closest = closest_hits(*structure, make_batch(rays));
    for (std::size_t i = 0; i < rays.size(); ++i) {
      std::vector<IntegerHit> hits;
      for (const Hit& h : hits_of(all, i)) hits.push_back({h.t, h.id.prim, h.is_front});
      ASSERT_EQ(hits, expected[i]) << "ray " << i;
      ASSERT_EQ(closest[i].id.prim, hits.empty() ? kNoId : hits.front().triangle) << "ray " << i;
    }
  }
}

}  // namespace
}  // namespace strahl::test
