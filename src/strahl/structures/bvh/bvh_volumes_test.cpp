// Hierarchies over each kind of volume and in each order: answers, containment, work.
#include <cmath>
#include <stdexcept>
#include <string>
#include <tests/support/against_brute.h>
#include <tests/support/mesh_maker.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/bounds/all_volumes.h>
#include <strahl/structures/bvh/bvh_breaker_test.h>

namespace strahl {

namespace test {
namespace {

const std::string kTraversals[] = {"dfs", "ordered", "direction", "heap"};

std::vector<std::string> kinds() {
  std::vector<std::string> names;
  for (const BoundingVolumeInfo& info : kBoundingVolumes) names.emplace_back(info.name);
  names.emplace_back("auto");
  return names;
}

Geometry balls(int count, Rng& rng) {
  Geometry g;
  g.kind = PrimitiveKind::sphere;
  for (int i = 0; i < count; ++i)
    g.spheres.push_back({{rng.uniform(), rng.uniform(), rng.uniform()}, rng.uniform(0.01, 0.1)});
  return g;
}

Geometry cones(int count, Rng& rng) {
  Geometry g;
  g.kind = PrimitiveKind::cone;
  for (int i = 0; i < count; ++i) {
    const Vec3d base{rng.uniform(), rng.uniform(), rng.uniform()};
    const Vec3d axis{rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), rng.uniform(0.01, 0.2)};
    g.cones.push_back({base, rng.uniform(0.0, 0.05), base + axis, rng.uniform(0.01, 0.05)});
  }
  return g;
}

/// Triangles, spheres and cones, once as they are and once turned and scaled, and a NaN.
ScenePtr mixed_scene(std::size_t triangles, int curved) {
  Rng rng(11);
  SceneData data;
  MeshMaker mesh = soup(triangles, 0.08, 12);
  mesh.triangle({0, 0, 0}, {std::nan(""), 0, 0}, {0, 1, 0});
  data.geometries = {mesh.geometry(), balls(curved, rng), cones(curved, rng)};
  for (std::uint32_t i = 0; i < 3; ++i) data.geometries[i].geometry_id = i;
  const double c = std::cos(0.7), s = std::sin(0.7);
  Affine turned;
  turned.m = {{{1.3 * c, -0.8 * s, 0.1, 1.5}, {1.3 * s, 0.8 * c, 0.0, -0.5}, {0.2, 0.0, 0.9, 0.2}}};
  data.instances = {{0, 3, Affine{}, 0}, {0, 3, turned, 1}};
  return std::make_shared<const Scene>(std::move(data));
}

std::vector<Vec3d> places(const Scene& scene) {
  std::vector<Vec3d> points;
  for (std::uint32_t i = 0; i < scene.size(); ++i)
    if (const Aabb box = scene.bounds(i); !box.is_empty()) points.push_back(box.center());
  return points;
}

TEST(BvhVolumes, AllKindsInAllOrdersAnswerAsBruteForce) {
  const ScenePtr scene = mixed_scene(60, 15);
  const std::vector<Ray> rays = rays_through(places(*scene), scene->total_bounds(), 15, 13);
  for (const std::string& kind : kinds())
    for (const std::string& traversal : kTraversals)
      expect_same_answers(scene, rays, "bvh:bv=" + kind + ",leaf_size=2,traversal=" + traversal);
}

TEST(BvhVolumes, FarFromTheOriginAndAcrossTheRangeOfFloatsNothingIsLost) {
  for (const double scale : {1e-30, 1.0, 1e30, 1e60}) {
    MeshMaker mesh;
    Rng rng(14);
    std::vector<Vec3d> points;
    for (int i = 0; i < 60; ++i) {
      Vec3d at{rng.uniform(), rng.uniform(), rng.uniform()};
      if (i % 2 == 0) at = at + Vec3d{4096, -4096, 1};
      const auto near = [&] {
        return scale * (at + 0.1 * Vec3d{rng.uniform(), rng.uniform(), rng.uniform()});
      };
      mesh.triangle(near(), near(), near());
      points.push_back(scale * at);
    }
    const ScenePtr scene = mesh.scene();
    const std::vector<Ray> rays = rays_through(points, scene->total_bounds(), 20, 15);
    for (const std::string& kind : kinds())
      expect_same_answers(scene, rays, "bvh:leaf_size=1,bv=" + kind);
  }
}

TEST(BvhVolumes, LargeNodesAreWrappedAroundBoxes) {
  const ScenePtr scene = mixed_scene(5 * NodeContents::kMost / 8, 10);
  const std::vector<Ray> rays = rays_through(places(*scene), scene->total_bounds(), 5, 16);
  for (const std::string kind : {"sphere", "hull"})
    expect_same_answers(scene, rays, "bvh:bv=" + kind);
}

TEST(BvhVolumes, AreTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const ScenePtr scene = mixed_scene(100, 20);
  BuildContext two;
  two.executor = Executor::with_threads(2);
  for (const std::string& kind : kinds())
    EXPECT_EQ(build(scene, "bvh:bv=" + kind)->tree_hash(),
              build(scene, "bvh:bv=" + kind, two)->tree_hash());
}

/// Sums of closest hits, ray by ray, of one order.
std::vector<Counters> work_per_ray(const ScenePtr& scene, const std::vector<Ray>& rays,
                                   const std::string& spec) {
  const auto built = build(scene, spec);
  std::vector<Counters> work;
  for (const Ray& ray : rays) work.push_back(work_of(*built, {ray}));
  return work;
}

TEST(BvhVolumes, TheHeapNeverOpensMoreNodesThanOtherOrdersOnAnyRay) {
  for (const ScenePtr& scene : {mixed_scene(300, 60), walls(5, 1.0, {0, 0, 0}).scene()}) {
    const std::vector<Ray> rays = rays_through(places(*scene), scene->total_bounds(), 20, 17);
    for (const std::string kind : {"aabb", "sphere", "shell", "intersection"}) {
      const std::string spec = "bvh:leaf_size=1,bv=" + kind + ",traversal=";
      const auto heap = work_per_ray(scene, rays, spec + "heap");
      std::size_t fewer = 0;
      for (const char* other : {"dfs", "ordered", "direction"}) {
        const auto work = work_per_ray(scene, rays, spec + other);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          ASSERT_LE(heap[i].traversal_steps, work[i].traversal_steps) << spec << i;
          ASSERT_LE(heap[i].leaves, work[i].leaves) << spec << i;
          fewer += heap[i].traversal_steps < work[i].traversal_steps;
        }
      }
      EXPECT_GT(fewer, rays.size() / 10) << spec;
    }
  }
}

TEST(BvhVolumes, TighterKindsLetFewerRaysThrough) {
  const ScenePtr scene = soup(500, 0.04, 18).scene();
  Rng rng(19);
  std::vector<Ray> rays;
  for (int i = 0; i < 1000; ++i) {
    const Vec3d org = point_in(scene->total_bounds(), rng);
    rays.push_back({org, point_in(scene->total_bounds(), rng) - org});
  }
  const auto tests = [&](const std::string& kind) {
    return work_of(*build(scene, "bvh:leaf_size=1,traversal=dfs,bv=" + kind), rays).primitives;
  };
  const auto boxes = tests("aabb");
  EXPECT_EQ(tests("kdop6"), boxes);
  EXPECT_LT(tests("kdop14"), boxes);
  EXPECT_LT(tests("kdop26"), tests("kdop14"));
  EXPECT_LT(tests("hull"), tests("obb"));
  EXPECT_LT(tests("intersection"), tests("obb"));
}

TEST(BvhVolumes, ValidateSeesAVolumeThatIsTooSmall) {
  const ScenePtr scene = mixed_scene(100, 20);
  BvhOptions options;
  options.bv = BvhVolume::sphere;
  Bvh bvh(*scene, options, {});
  EXPECT_NO_THROW(bvh.validate(*scene));
  auto& tree = BvhBreaker::tree<SphereVolume>(bvh);
  for (const bool is_leaf : {false, true}) {
    for (auto& node : BvhBreaker::nodes(tree)) {
      if (node.is_leaf() != is_leaf) continue;
      const SphereVolume kept = node.volume;
      EnclosedSet smaller;
      smaller.add(Ball{kept.ball().center, kept.ball().radius * 0.9});
      node.volume = SphereVolume::enclose(smaller);
      EXPECT_THROW(bvh.validate(*scene), std::logic_error);
      node.volume = kept;
      break;
    }
  }
  EXPECT_NO_THROW(bvh.validate(*scene));
}

TEST(BvhVolumes, ReportTheirOwnAreasAndBytes) {
  SceneData data;
  Geometry g;
  g.kind = PrimitiveKind::sphere;
  g.spheres = {{{0, 0, 0}, 1.0}, {{6, 0, 0}, 1.0}};
  data.geometries.push_back(g);
  const auto scene = std::make_shared<const Scene>(std::move(data));
  const BuildReport report = build(scene, "bvh:bv=sphere,leaf_size=1,traverse_cost=2")->report();
  // Radii 4, 1, 1: areas 16 to 1 each.
  EXPECT_NEAR(report.sah_cost, (2.0 + 1.0 / 16 + 1.0 / 16) / 2.0, 1e-5);
  EXPECT_EQ(report.bytes, 3 * 24u + 2 * 4u);
}

}  // namespace
}  // namespace test
}  // namespace strahl
