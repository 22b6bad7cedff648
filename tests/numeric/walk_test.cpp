// Walks by resume cursors: stepping from hit to hit lists exactly what `all` lists, where many hits
// share one t, on surfaces, and over pauses in which t_min has moved on.
#include <string>
#include <tests/numeric/solids.h>
#include <tests/support/queries.h>
#include <tests/support/shared.h>

#include <gtest/gtest.h>

#include <strahl/io/load.h>

namespace strahl::test {
namespace {

/// The hits of every ray found one by one, each step resuming after the hit before.
std::vector<std::vector<Hit>> walk(const Accelerator& accelerator, std::vector<Ray> rays,
                                   bool moves_t_min) {
  std::vector<std::vector<Hit>> found(rays.size());
  std::vector<Cursor> after(rays.size(), {-1.0, {0, 0, 0}});
  for (bool is_walking = true; is_walking;) {
    RayBatch batch = make_batch(rays);
    batch.after = after;
    const std::vector<Hit> hits = closest_hits(accelerator, batch);
    is_walking = false;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (!hits[i].is_hit()) continue;
      found[i].push_back(hits[i]);
      after[i] = {hits[i].t, hits[i].id};
      if (moves_t_min) rays[i].t_min = hits[i].t;  // closed: ties at this t remain
      is_walking = true;
    }
  }
  return found;
}

void expect_walks_list_all(const std::shared_ptr<const Scene>& scene,
                           const std::vector<Ray>& rays) {
  const AllHits expected = all_hits(*build(scene, "brute_force"), make_batch(rays));
  ASSERT_GT(expected.hits.size(), rays.size() / 2);
  for (const auto& structure : build_all(scene))
    for (const bool moves_t_min : {false, true}) {
      SCOPED_TRACE(structure->spec());
      const bool is_brute = structure->spec() == "brute_force";  // a step tests every primitive
      const std::size_t count = is_brute ? std::max<std::size_t>(rays.size() / 20, 5) : rays.size();
      const auto found =
          walk(*structure, {rays.begin(), rays.begin() + std::ptrdiff_t(count)}, moves_t_min);
      for (std::size_t i = 0; i < count; ++i) {
        const std::span<const Hit> hits = hits_of(expected, i);
        ASSERT_EQ(found[i].size(), hits.size()) << "ray " << i;
        for (std::size_t k = 0; k < hits.size(); ++k)
          ASSERT_TRUE(same_bits(found[i][k], hits[k])) << "ray " << i << " hit " << k;
      }
    }
}

std::vector<Ray> lattice_rays(std::size_t count, std::uint32_t reach, double scale) {
  Rng rng(3);
  std::vector<Ray> rays;
  const auto draw = [&] { return scale * (static_cast<double>(rng.below(2 * reach + 1)) - reach); };
  while (rays.size() < count) {
    Vec3d org, dir;
    for (int axis = 0; axis < 3; ++axis) org[axis] = draw(), dir[axis] = draw();
    if (norm_max(dir) > 0) rays.push_back({org, dir});
  }
  return rays;
}

/// Every triangle several times, in several geometries and instances, some of them mirrored.
std::shared_ptr<const Scene> layered_cubes() {
  IntegerMesh twice = integer_cube(2);
  const IntegerMesh once = twice;
  twice.insert(twice.end(), once.rbegin(), once.rend());
  SceneData data;
  for (std::uint32_t g = 0; g < 3; ++g) {
    data.geometries.emplace_back().mesh = as_mesh(g == 1 ? twice : integer_octahedron(3));
    data.geometries.back().geometry_id = 7 - g;  // descending: ids, not positions, break ties
  }
  data.instances = {{0, 3, Affine{}, 9},
                    {1, 2, Affine::scaling({-1, 1, 1}), 4},
                    {0, 2, Affine::scaling({0.5, 0.5, 0.5}), 6}};
  return std::make_shared<const Scene>(std::move(data));
}

TEST(Walk, ListsAllHitsWhereManyShareOneParameter) {
  expect_walks_list_all(layered_cubes(), lattice_rays(2000, 4, 1.0));
}
TEST(Walk, ListsAllHitsOfAClosedSurface) {
  expect_walks_list_all(scene_of(torus(1.0, 0.4, 24, 16)), lattice_rays(2000, 6, 0.125));
}
TEST(Walk, ListsAllHitsOfADeepScene) {
  STRAHL_REQUIRE_SHARED("scenes/bush.ply");
  const auto scene =
      std::make_shared<const Scene>(load_scene_data((shared_dir() / "scenes/bush.ply").string()));
  const Vec3d center = scene->total_bounds().center();
  std::vector<Ray> rays = lattice_rays(60, 5, 30.0);
  for (Ray& ray : rays) ray.dir = center - ray.org;
  expect_walks_list_all(scene, rays);
}

}  // namespace
}  // namespace strahl::test
