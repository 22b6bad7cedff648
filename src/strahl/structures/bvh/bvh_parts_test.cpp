// Hierarchies whose builder cuts primitives: every hit once, whatever holds the parts.
#include <algorithm>
#include <stdexcept>
#include <string>
#include <tests/support/against_brute.h>
#include <tests/support/mesh_maker.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/bounds/all_volumes.h>
#include <strahl/geometry/outline.h>
#include <strahl/structures/bvh/bvh_breaker_test.h>

namespace strahl {

namespace test {
namespace {

/// Triangles that cross the cube from side to side, and a fan of flat ones with shared edges.
MeshMaker long_triangles(int count, std::uint64_t seed) {
  Rng rng(seed);
  MeshMaker mesh;
  const auto anywhere = [&] { return Vec3d{rng.uniform(), rng.uniform(), rng.uniform()}; };
  for (int i = 0; i < count; ++i) {
    const Vec3d a = anywhere(), b = anywhere();
    mesh.triangle(a, b, b + 0.02 * anywhere());
  }
  for (int i = 0; i < 16; ++i)
    mesh.triangle({0, 0, 0.5}, {1, i / 16.0, 0.5}, {1, (i + 1) / 16.0, 0.5});
  return mesh;
}

/// Long triangles, spheres and a cone, once as they are and once turned.
ScenePtr long_scene(int count) {
  SceneData data;
  data.geometries.push_back(long_triangles(count, 1).geometry());
  Geometry curved;
  curved.kind = PrimitiveKind::sphere, curved.geometry_id = 1;
  curved.spheres = {{{0.5, 0.5, 0.5}, 0.4}, {{0.2, 0.7, 0.3}, 0.15}};
  data.geometries.push_back(curved);
  curved = {};
  curved.kind = PrimitiveKind::cone, curved.geometry_id = 2;
  curved.cones = {{{0, 0, 0}, 0.05, {1, 1, 1}, 0.01}};
  data.geometries.push_back(curved);
  Affine turned = Affine::translation({0.7, 0.1, -0.2}) * Affine::rotation(0.1, 0.3, 0.2, 0.927);
  data.instances = {{0, 3, Affine{}, 0}, {0, 3, turned, 1}};
  return std::make_shared<const Scene>(std::move(data));
}

std::vector<Ray> rays_for(const Scene& scene, int count) {
  std::vector<Vec3d> points;
  for (std::uint32_t i = 0; i < scene.size(); ++i) {
    const Outline outline = scene.outline(i);
    for (const Ball& ball : outline.balls()) points.push_back(ball.center);
  }
  return rays_through(points, scene.total_bounds(), count, 3);
}

std::vector<std::string> specs() {
  std::vector<std::string> all;
  for (const BoundingVolumeInfo& info : kBoundingVolumes)
    all.push_back("leaf_size=1,bv=" + std::string(info.name));
  all.emplace_back("bv=auto,leaf_size=2");
  for (const char* traversal : {"dfs", "heap"})
    all.push_back("leaf_size=3,traversal=" + std::string(traversal));
  for (const char* optimise : {"rotations", "reinsertion"})
    all.push_back("arity=6,leaf_size=1,optimise=" + std::string(optimise));
  return all;
}

TEST(BvhParts, AreHitOnceAndAsByBruteForce) {
  const ScenePtr scene = long_scene(60);
  const std::vector<Ray> rays = rays_for(*scene, 25);
  const RayBatch batch = make_batch(rays);
  const auto oracle = build(scene, "brute_force");
  const auto counts = hit_counts(*oracle, batch);
  const auto sides = sides_of(*oracle, batch);
  for (const std::string& options : specs()) {
    const std::string spec = "bvh:builder=spatial,duplicates=2," + options;
    SCOPED_TRACE(spec);
    expect_same_answers(scene, rays, spec);
    const auto bvh = build(scene, spec);
    EXPECT_GT(bvh->report().references, scene->size());
    EXPECT_EQ(hit_counts(*bvh, batch), counts);
    EXPECT_EQ(sides_of(*bvh, batch), sides);
  }
}

TEST(BvhParts, AWalkFromHitToHitMeetsEachOnce) {
  const ScenePtr scene = long_scene(60);
  const auto bvh = build(scene, "bvh:builder=spatial,duplicates=2,leaf_size=1");
  const std::vector<Ray> rays = rays_for(*scene, 10);
  const AllHits all = all_hits(*build(scene, "brute_force"), make_batch(rays));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    RayBatch batch = make_batch(std::span(rays).subspan(i, 1));
    std::vector<Cursor> after{{-1.0, {}}};
    batch.after = after;
    for (const Hit& expected : hits_of(all, i)) {
      const Hit hit = closest_hits(*bvh, batch).front();
      ASSERT_TRUE(same_bits(hit, expected)) << i;
      after.front() = {hit.t, hit.id};
    }
    EXPECT_EQ(closest_hits(*bvh, batch).front().reference, kNoId) << i;
  }
}

TEST(BvhParts, ReferToThingsOnceWithoutABudget) {
  const ScenePtr scene = long_scene(100);
  BvhOptions options;
  options.builder = BvhBuilder::spatial, options.duplicates = 0.0;
  EXPECT_TRUE(Bvh(*scene, options, {}).refers_once());
  options.duplicates = 1.0;
  EXPECT_FALSE(Bvh(*scene, options, {}).refers_once());
}

TEST(BvhParts, ValidateSeesAPartThatIsMissingOrTooSmall) {
  const ScenePtr scene = long_triangles(50, 7).scene();
  BvhOptions options;
  options.builder = BvhBuilder::spatial, options.duplicates = 2.0, options.leaf_size = 1;
  Bvh bvh(*scene, options, {});
  EXPECT_NO_THROW(bvh.validate(*scene));
  auto& tree = BvhBreaker::tree<AabbVolume>(bvh);
  auto& references = BvhBreaker::references(tree);
  int shrunk = 0, seen_shrunk = 0, stolen = 0, seen_stolen = 0;
  const auto is_refused = [&] {
    try {
      bvh.validate(*scene);
    } catch (const std::logic_error&) {
      return true;
    }
    return false;
  };
  for (auto& node : BvhBreaker::nodes(tree)) {
    if (!node.is_leaf()) continue;
    const AabbVolume kept = node.volume;
    Aabb box = kept.box();
    const int axis = box.longest_axis();
    box.hi[axis] = 0.75 * box.hi[axis] + 0.25 * box.lo[axis];
    node.volume = AabbVolume(box);
    ++shrunk, seen_shrunk += is_refused();
    node.volume = kept;
    // Another's part in its place.
    std::uint32_t& reference = references[node.first];
    const std::uint32_t own = reference;
    reference = (own + 1) % scene->size();
    ++stolen, seen_stolen += is_refused();
    reference = own;
  }
  // Parts smaller than the distance of the points looked at may go unseen.
  EXPECT_GT(seen_shrunk, shrunk / 3);
  EXPECT_GT(seen_stolen, stolen / 3);
  EXPECT_NO_THROW(bvh.validate(*scene));
}

TEST(BvhParts, InAHierarchyThatHasNoneAreRefused) {
  const ScenePtr scene = soup(50, 0.1, 4).scene();
  BvhOptions options;
  options.leaf_size = 1;
  Bvh bvh(*scene, options, {});
  auto& tree = BvhBreaker::tree<AabbVolume>(bvh);
  for (auto& node : BvhBreaker::nodes(tree)) node.volume = AabbVolume(scene->total_bounds());
  BvhBreaker::references(tree)[0] = BvhBreaker::references(tree)[1];
  try {
    bvh.validate(*scene);
    ADD_FAILURE() << "accepted";
  } catch (const std::logic_error& error) {
    EXPECT_STREQ(error.what(), "bvh: a primitive is not in exactly one leaf");
  }
}

}  // namespace
}  // namespace test
}  // namespace strahl
