#include <algorithm>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/generators.h>
#include <strahl/measure/advisor.h>
#include <strahl/measure/comparison.h>
#include <strahl/measure/statistics.h>
#include <strahl/measure/thinned.h>
#include <strahl/render/framing.h>

namespace strahl {
namespace {

std::shared_ptr<const Scene> scene_of(const char* generator) {
  return std::make_shared<const Scene>(generate_scene(generator));
}

Advice advice_for(const std::shared_ptr<const Scene>& scene, double rays) {
  AdviceOptions options;
  options.rays = rays;
  return advise(scene, options);
}

TEST(Thinned, KeepsEveryNthPrimitiveOfEachKind) {
  const auto scene = scene_of("rings:4");  // spheres and cylinders
  ASSERT_GT(scene->size(), 1000u);
  const auto some = thinned(scene, 300);
  EXPECT_GE(some->size(), 150u);
  EXPECT_LE(some->size(), 310u);
  EXPECT_GT(some->counts().spheres, 0u);
  EXPECT_GT(some->counts().cones, 0u);
  EXPECT_EQ(some->hash(), thinned(scene, 300)->hash());
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_GT(some->total_bounds().extent()[axis], 0.8 * scene->total_bounds().extent()[axis]);
}

TEST(Thinned, LeavesSmallScenesAlone) {
  const auto scene = scene_of("tetra:3");
  EXPECT_EQ(thinned(scene, scene->size()), scene);
  EXPECT_EQ(thinned(scene, 1)->size(), 1u);
  const auto empty = std::make_shared<const Scene>(SceneData{});
  EXPECT_EQ(thinned(empty, 0), empty);
}

TEST(Thinned, TakesTrianglesAsTheyAreInFloatsAndDoubles) {
  for (const bool is_double : {false, true}) {
    SceneData data;
    std::vector<std::uint32_t> indices;
    std::vector<Vec3d> vertices;
    for (std::uint32_t i = 0; i < 300; ++i) {
      indices.push_back(i);
      vertices.push_back({0.1 * i, 0.3 * (i % 7), 0.7 * (i % 3)});
    }
    Geometry& geometry = data.geometries.emplace_back();
    geometry.mesh = is_double
                        ? make_mesh(vertices, indices)
                        : make_mesh(std::vector<Vec3f>(vertices.begin(), vertices.end()), indices);
    const auto scene = std::make_shared<const Scene>(std::move(data));
    const auto some = thinned(scene, 10);
    ASSERT_EQ(some->size(), 10u);
    EXPECT_EQ(some->geometries()[0].mesh.vertices.is_double, is_double);
    for (std::uint32_t i = 0; i < 10; ++i) {
      EXPECT_EQ(some->bounds(i).lo, scene->bounds(5 + 10 * i).lo);
      EXPECT_EQ(some->bounds(i).hi, scene->bounds(5 + 10 * i).hi);
    }
  }
}

TEST(Thinned, LeavesOutInstancesOnlyWhereTheyAreTooMany) {
  SceneData data = generate_scene("tetra:2");  // 16 triangles
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Affine to_world = Affine::translation({3.0 * i, 0, 0});
    data.instances.push_back({0, static_cast<std::uint32_t>(data.geometries.size()), to_world, i});
  }
  const auto scene = std::make_shared<const Scene>(std::move(data));
  const auto many = thinned(scene, scene->size() / 2);
  EXPECT_EQ(many->instances().size(), 1000u);
  EXPECT_EQ(many->size(), scene->size() / 2);
  const auto few = thinned(scene, 100);
  EXPECT_LT(few->instances().size(), 15u);
  EXPECT_LE(few->size(), 120u);
  EXPECT_GE(few->size(), 50u);
}

TEST(Advisor, PredictsEveryCandidateSoonestFirst) {
  const Advice advice = advice_for(scene_of("balls:2"), 1e6);
  ASSERT_GE(advice.predictions.size(), 6u);
  std::set<std::string> specs;
  for (const Prediction& p : advice.predictions) {
    specs.insert(p.spec);
    EXPECT_GT(p.seconds_per_ray, 0.0) << p.spec;
    EXPECT_DOUBLE_EQ(p.total_seconds, p.build_seconds + 1e6 * p.seconds_per_ray) << p.spec;
    EXPECT_GE(p.total_seconds, advice.fastest().total_seconds);
    EXPECT_GE(p.bytes, advice.smallest().bytes);
  }
  EXPECT_EQ(specs.size(), advice.predictions.size());
  EXPECT_GT(advice.confidence, 0.0);
  EXPECT_LE(advice.confidence, 1.0);
  EXPECT_EQ(advice.smallest().spec, "brute_force");
}

TEST(Advisor, WeighsBuildingAgainstRays) {
  const auto scene = scene_of("terrain:10");
  AdviceOptions options;
  options.candidates = {"bvh", "brute_force"};
  options.rays = 0;
  EXPECT_EQ(advise(scene, options).fastest().spec, "brute_force");
  options.rays = 1e9;
  const Advice many = advise(scene, options);
  EXPECT_EQ(many.fastest().spec, "bvh");
  EXPECT_GT(many.confidence, 0.9);
}

TEST(Advisor, ContinuesLargeScenesFromThinnedOnes) {
  const auto scene = scene_of("soup:150000");
  AdviceOptions options;
  options.candidates = {"bvh:builder=lbvh", "wide_bvh"};
  const Advice advice = advise(scene, options);
  EXPECT_LE(advice.trial_primitives, scene->size() / 2);
  for (const Prediction& p : advice.predictions) {
    const auto bytes = static_cast<double>(build(scene, p.spec)->report().bytes);
    EXPECT_NEAR(p.bytes, bytes, 0.15 * bytes) << p.spec;
  }
}

TEST(Advisor, KnowsTheRestOfWhatIsNotWorthALargeTrial) {
  const auto scene = scene_of("soup:80000");
  AdviceOptions options;
  options.candidates = {"bvh:builder=lbvh", "wide_bvh"};
  options.rays = 100;
  const Advice advice = advise(scene, options);
  EXPECT_EQ(advice.fastest().spec, "bvh:builder=lbvh");
  EXPECT_EQ(advice.trial_primitives, scene->size());
  const auto bytes = static_cast<double>(build(scene, "wide_bvh")->report().bytes);
  EXPECT_NEAR(advice.predictions[1].bytes, bytes, 0.15 * bytes);
}

TEST(Advisor, AdvisesForAnotherNumberOfRaysWithoutAnotherTrial) {
  const auto scene = scene_of("terrain:10");
  AdviceOptions options;
  options.candidates = {"bvh", "brute_force"};
  const Advice many = advise(scene, options), none = for_rays(many, 0);
  EXPECT_EQ(many.fastest().spec, "bvh");
  EXPECT_EQ(none.fastest().spec, "brute_force");
  EXPECT_EQ(none.fastest().total_seconds, none.fastest().build_seconds);
}

/// The measured time of the advisor's choice over that of the best, at worst over some workloads
/// and numbers of rays. Beside the candidates one that is never a good choice.
double worst_loss(const std::shared_ptr<const Scene>& scene) {
  AdviceOptions wanted;
  std::erase(wanted.candidates, "brute_force");
  std::erase(wanted.candidates, "two_level");
  wanted.candidates.push_back("quadtree");
  wanted.view = default_view(*scene, 64, 64);
  ComparisonOptions options;
  options.specs = wanted.candidates;
  options.workloads = {WorkloadKind::primary, WorkloadKind::random};
  options.rays = 4000, options.min_rays = 500, options.repeats = 3, options.seconds_per_cell = 0.02;
  const SceneComparison measured = compare_structures(scene, wanted.view, options);
  double worst = 1.0;
  for (std::size_t w = 0; w < options.workloads.size(); ++w) {
    wanted.workload = options.workloads[w];
    const Advice trial = advise(scene, wanted);
    for (const double rays : {1e3, 1e6}) {
      const std::string chosen = for_rays(trial, rays).fastest().spec;
      double best = 1e300, of_chosen = 0.0;
      for (const ComparisonRow& row : measured.rows) {
        const ComparisonCell& cell = row.cells[w];
        const double total = row.build.seconds + rays * median(cell.seconds) / double(cell.rays);
        best = std::min(best, total);
        if (row.spec == chosen) of_chosen = total;
      }
      worst = std::max(worst, of_chosen / best);
    }
  }
  return worst;
}

// bench/advisor_bench holds the whole: twenty scenes, six workloads, 1.10 on average, 1.5 at worst.
TEST(Advisor, LosesLittleAgainstTheBest) {
  for (const char* generator : {"balls:2", "terrain:20"})
    EXPECT_LT(worst_loss(scene_of(generator)), 2.0) << generator;
}

TEST(Advisor, HandlesAnEmptySceneAndOnePrimitive) {
  EXPECT_EQ(advice_for(std::make_shared<const Scene>(SceneData{}), 1000).trial_primitives, 0u);
  EXPECT_EQ(advice_for(thinned(scene_of("tetra:2"), 1), 1000).trial_primitives, 1u);
}

TEST(Advisor, TakesTheRaysItIsGiven) {
  const auto scene = scene_of("balls:2");
  Workload sample;
  sample.any.push_back({{0, 0, 9}, {0, 0, -1}});
  AdviceOptions options;
  options.sample = &sample;
  EXPECT_GT(advise(scene, options).fastest().total_seconds, 0.0);
}

TEST(Advisor, RefusesNonsense) {
  const auto scene = scene_of("balls:1");
  AdviceOptions options;
  options.candidates = {};
  EXPECT_THROW(advise(scene, options), Error);
  options.candidates = {"no_such_structure"};
  EXPECT_THROW(advise(scene, options), Error);
  options.candidates = {"bvh"}, options.rays = -1;
  EXPECT_THROW(advise(scene, options), Error);
  options.rays = 1;
  BuildContext context;
  context.progress = [](double, std::string_view) { return false; };
  EXPECT_THROW(advise(scene, options, context), Error);
}

}  // namespace
}  // namespace strahl
