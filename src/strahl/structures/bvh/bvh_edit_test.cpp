// Hierarchies that things are taken out of and put in: the same answers as one built anew.
#include <algorithm>
#include <string>
#include <tests/support/against_brute.h>
#include <tests/support/mesh_maker.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/geometry/subset_source.h>
#include <strahl/query/scene_visitor.h>
#include <strahl/structures/bvh/bvh.h>
#include <strahl/structures/bvh/bvh_refit.h>

namespace strahl {

namespace test {
namespace {

std::uint64_t hash_of(const Bvh& bvh) {
  Hash64 hash;
  bvh.hash_into(hash);
  return hash.digest();
}

std::vector<Hit> hits_of(const Bvh& bvh, const Scene& scene, const Ray& ray) {
  SceneVisitor prims(scene);
  std::vector<Hit> hits;
  CollectHits query(ray, {}, hits);
  NoCounters counters;
  prims.begin_ray();
  bvh.trace(prims, PreparedRay(ray, scene.world_frame()), query, counters);
  std::sort(hits.begin(), hits.end(), comes_before);
  hits.erase(std::unique(hits.begin(), hits.end(), is_same_hit), hits.end());
  return hits;
}

/// All hits of the things that are not hidden.
void expect_answers(const Bvh& bvh, const Scene& scene, const SubsetSource& shown,
                    const std::vector<Ray>& rays, const AllHits& all) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::vector<Hit> got = hits_of(bvh, scene, rays[i]);
    std::size_t at = 0;
    for (const Hit& hit : test::hits_of(all, i)) {
      if (shown.is_hidden(hit.reference)) continue;
      ASSERT_LT(at, got.size()) << "ray " << i;
      ASSERT_TRUE(same_bits(got[at++], hit)) << "ray " << i;
    }
    ASSERT_EQ(at, got.size()) << "ray " << i;
  }
}

std::vector<BvhOptions> variants() {
  std::vector<BvhOptions> all(6);
  for (BvhOptions& options : all) options.rebuild_factor = 1000.0;
  all[1].leaf_size = 1, all[1].optimise = BvhOptimise::reinsertion;
  all[2].arity = 8, all[2].builder = BvhBuilder::goldsmith_salmon;
  all[3].builder = BvhBuilder::spatial, all[3].duplicates = 1.0;
  all[4].bv = BvhVolume::obb, all[4].traversal = BvhTraversal::heap;
  all[5].bv = BvhVolume::automatic, all[5].builder = BvhBuilder::lbvh;
  return all;
}

TEST(BvhEdit, AnswersAsIfBuiltAnewWhateverComesAndGoes) {
  const ScenePtr scene = soup(200, 0.2, 1).scene();
  std::vector<Vec3d> points;
  for (std::uint32_t i = 0; i < scene->size(); ++i) points.push_back(scene->bounds(i).center());
  const std::vector<Ray> rays = rays_through(points, scene->total_bounds(), 12, 2);
  const AllHits all = all_hits(*build(scene, "brute_force"), make_batch(rays));
  for (const BvhOptions& options : variants()) {
    SCOPED_TRACE(format_options(options));
    Rng rng(3);
    SubsetSource shown(*scene);
    for (std::uint32_t i = 0; i < 40; ++i) shown.hide(rng.below(200));
    Bvh bvh(shown, options, {});
    for (std::uint64_t step = 1; step <= 8; ++step) {
      for (int i = 0; i < 12; ++i) shown.hide(rng.below(200)), shown.show(rng.below(200));
      bvh.refit(shown, {});
      EXPECT_EQ(bvh.refits(), step) << "was not built anew";
      ASSERT_NO_THROW(bvh.validate(shown));
      expect_answers(bvh, *scene, shown, rays, all);
    }
  }
}

TEST(BvhEdit, StaysNearTheCostOfABuild) {
  const ScenePtr scene = soup(2000, 0.03, 4).scene();
  BvhOptions options;
  options.rebuild_factor = 1000.0;
  SubsetSource shown(*scene);
  for (std::uint32_t i = 0; i < 2000; i += 2) shown.hide(i);
  Bvh bvh(shown, options, {});
  Rng rng(5);
  for (int step = 0; step < 20; ++step) {  // half of all is exchanged
    for (int i = 0; i < 100; ++i) shown.hide(rng.below(2000)), shown.show(rng.below(2000));
    bvh.refit(shown, {});
  }
  EXPECT_EQ(bvh.refits(), 20u);
  EXPECT_LT(bvh.report().sah_cost, 1.15 * Bvh(shown, options, {}).report().sah_cost);
}

TEST(BvhEdit, BuildsAnewWhereManyThingsComeOrGo) {
  const ScenePtr scene = soup(100, 0.1, 6).scene();
  BvhOptions options;
  options.rebuild_factor = 1000.0;
  for (const std::uint32_t changes : {25u, 26u}) {
    SubsetSource shown(*scene);
    Bvh bvh(shown, options, {});
    for (std::uint32_t i = 0; i < changes; ++i) shown.hide(i);
    bvh.refit(shown, {});
    EXPECT_EQ(bvh.refits(), changes == 25 ? 1u : 0u);
    EXPECT_NO_THROW(bvh.validate(shown));
  }
}

TEST(BvhEdit, CanBecomeEmptyAndFullAgain) {
  const ScenePtr scene = soup(40, 0.1, 7).scene();
  SubsetSource shown(*scene);
  Bvh bvh(shown, {}, {});
  for (std::uint32_t i = 0; i < 40; ++i) {
    shown.hide(i);
    bvh.refit(shown, {});
    ASSERT_NO_THROW(bvh.validate(shown)) << i;
  }
  EXPECT_EQ(bvh.report().nodes, 0u);
  for (std::uint32_t i = 0; i < 40; ++i) {
    shown.show(i);
    bvh.refit(shown, {});
    ASSERT_NO_THROW(bvh.validate(shown)) << i;
  }
  EXPECT_EQ(bvh.report().references, 40u);
}

TEST(BvhEdit, KeepsTheDepthWhereEverythingCoincides) {
  MeshMaker mesh;
  for (int i = 0; i < 3000; ++i) mesh.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const ScenePtr scene = mesh.scene();
  BvhOptions options;
  options.leaf_size = 1;
  SubsetSource shown(*scene);
  for (std::uint32_t i = 0; i < 600; ++i) shown.hide(i);
  Bvh bvh(shown, options, {});
  for (std::uint32_t i = 0; i < 600; ++i) shown.show(i);
  bvh.refit(shown, {});
  EXPECT_EQ(bvh.refits(), 1u);
  EXPECT_NO_THROW(bvh.validate(shown));
}

TEST(BvhEdit, LeavesEverythingWhereItFails) {
  const ScenePtr scene = soup(500, 0.1, 8).scene();
  SubsetSource shown(*scene);
  Bvh bvh(shown, {}, {});
  const std::uint64_t before = hash_of(bvh);
  shown.hide(7);
  for (const std::uint64_t limit : {1'000u, 30'000u}) {
    BuildContext small;
    small.memory_limit = limit;
    EXPECT_THROW(bvh.refit(shown, small), Error);
    EXPECT_EQ(hash_of(bvh), before);
  }
}

}  // namespace
}  // namespace test
}  // namespace strahl
