#include <memory>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/generators.h>
#include <strahl/measure/workloads.h>
#include <strahl/render/framing.h>

namespace strahl {
namespace {

std::unique_ptr<Accelerator> bvh_of(const char* generator) {
  return build(std::make_shared<const Scene>(generate_scene(generator)), "bvh");
}

Workload make(WorkloadKind kind, const Accelerator& accelerator, std::size_t rays,
              std::uint64_t seed = 1) {
  return make_workload(kind, accelerator, {default_view(accelerator.scene(), 8, 8), rays, seed});
}

bool have_same_rays(const std::vector<Ray>& a, const std::vector<Ray>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Ray& p, const Ray& q) {
    return p.org == q.org && p.dir == q.dir && p.t_min == q.t_min && p.t_max == q.t_max;
  });
}

bool is_float(double v) { return static_cast<double>(static_cast<float>(v)) == v; }

TEST(Workloads, NamesAreFoundAgainAndOthersAreErrors) {
  for (const WorkloadKind kind : kAllWorkloads) EXPECT_EQ(workload_kind(name_of(kind)), kind);
  try {
    workload_kind("primry");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(std::string(error.what()).find("primary shadow ao"), std::string::npos);
  }
}

TEST(Workloads, AreValidFloatsAboutAsManyAsAskedFor) {
  const auto accelerator = bvh_of("balls:2");
  for (const WorkloadKind kind : kAllWorkloads) {
    if (kind == WorkloadKind::whitted) continue;
    const Workload workload = make(kind, *accelerator, 2000);
    EXPECT_LE(workload.size(), 2000u) << name_of(kind);
    EXPECT_GE(workload.size(), 1600u) << name_of(kind);
    for (const auto* rays : {&workload.closest, &workload.any})
      for (const Ray& ray : *rays) {
        ASSERT_TRUE(is_valid(ray));
        for (int axis = 0; axis < 3; ++axis)
          ASSERT_TRUE(is_float(ray.org[axis]) && is_float(ray.dir[axis]));
        ASSERT_TRUE(is_float(ray.t_max));
      }
  }
}

TEST(Workloads, DependOnTheSeedOnly) {
  const auto accelerator = bvh_of("tetra:3");
  const auto other = build(std::make_shared<const Scene>(generate_scene("tetra:3")), "kd_tree");
  for (const WorkloadKind kind : kAllWorkloads) {
    const Workload a = make(kind, *accelerator, 500), b = make(kind, *other, 500);
    EXPECT_TRUE(have_same_rays(a.closest, b.closest) && have_same_rays(a.any, b.any));
  }
  EXPECT_FALSE(have_same_rays(make(WorkloadKind::random, *accelerator, 500, 1).closest,
                              make(WorkloadKind::random, *accelerator, 500, 2).closest));
}

TEST(Workloads, PrimaryRaysFillTilesOfTheImageOnce) {
  const auto accelerator = bvh_of("balls:1");
  const Workload workload = make(WorkloadKind::primary, *accelerator, 300);
  ASSERT_EQ(workload.closest.size(), 256u);
  std::vector<Vec3d> dirs;
  for (const Ray& ray : workload.closest) dirs.push_back(ray.dir);
  std::sort(dirs.begin(), dirs.end(), [](const Vec3d& a, const Vec3d& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  });
  EXPECT_EQ(std::adjacent_find(dirs.begin(), dirs.end()), dirs.end());
  // Four neighbours in a row of the sequence are a square of pixels: nearer than a tile is wide.
  const double pixel = length(workload.closest[1].dir - workload.closest[0].dir);
  for (std::size_t i = 0; i + 4 <= workload.closest.size(); i += 4)
    EXPECT_LT(length(workload.closest[i + 3].dir - workload.closest[i].dir), 2 * pixel);
}

TEST(Workloads, SecondaryRaysDoNotMeetWhereTheyStart) {
  const auto accelerator = bvh_of("icosphere:3");
  // Outside a convex body no bounced ray hits it again.
  for (const WorkloadKind kind : {WorkloadKind::diffuse, WorkloadKind::ao}) {
    const Workload workload = make(kind, *accelerator, 5000);
    const std::vector<Ray>& rays = workload.closest.empty() ? workload.any : workload.closest;
    ASSERT_EQ(rays.size(), 5000u);
    std::vector<std::uint8_t> any(rays.size());
    accelerator->any_hit(make_batch(rays), any);
    EXPECT_EQ(std::count(any.begin(), any.end(), 1), 0) << name_of(kind);
  }
}

TEST(Workloads, ShadowRaysEndAtTheLampAndSomeAreBlocked) {
  const auto accelerator = bvh_of("balls:3");
  const Workload workload = make(WorkloadKind::shadow, *accelerator, 5000);
  std::vector<std::uint8_t> any(workload.any.size());
  accelerator->any_hit(make_batch(workload.any), any);
  const auto blocked = std::count(any.begin(), any.end(), 1);
  EXPECT_GT(blocked, 250);
  EXPECT_LT(blocked, 4750);
}

TEST(Workloads, NothingSeenGivesNoSecondaryRays) {
  const auto accelerator = build(std::make_shared<const Scene>(SceneData{}), "bvh");
  for (const WorkloadKind kind : {WorkloadKind::shadow, WorkloadKind::ao, WorkloadKind::diffuse})
    EXPECT_EQ(make(kind, *accelerator, 100).size(), 0u);
  EXPECT_EQ(make(WorkloadKind::random, *accelerator, 100).size(), 100u);
}

TEST(RayTree, AGlassSphereBendsRaysTwiceAndReflectsInside) {
  SceneData data;
  data.materials.push_back({.transmission = 0.9, .refraction_index = 1.5});
  Geometry& glass = data.geometries.emplace_back();
  glass.kind = PrimitiveKind::sphere;
  glass.spheres.push_back({{0, 0, 0}, 1.0});
  data.lights.push_back({0, 0, 10});
  const auto accelerator = build(std::make_shared<const Scene>(std::move(data)), "brute_force");
  View view{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 1.0};
  const Workload tree = make_workload(WorkloadKind::whitted, *accelerator, {view, 4, 1});
  // Four eye rays hit; each sends one ray away and one in. Of the rays inside, each of depth 2, 3
  // and 4 sends one out, which is lost, and one on inside: 1 + 2 + 2 + 2 + 2.
  EXPECT_EQ(tree.closest.size(), 4u * 9);
  // Shadow rays leave the outer side of hits that face the lamp: depths 1, 3 and 5.
  EXPECT_EQ(tree.any.size(), 4u * 3);
}

}  // namespace
}  // namespace strahl
