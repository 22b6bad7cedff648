// tests/regression/ray_tree_counts_test.cpp - how many rays pictures of the standard scenes take:
// eye rays that hit exactly as published [Havran1999], the rest as counted by another program that
// follows the same rules but treats normals, self-hits and grazing lights in its own way.
#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

#include <strahl/catalog/catalog.h>
#include <strahl/io/generators.h>
#include <strahl/measure/workloads.h>

namespace strahl {
namespace {

struct Counted {
  const char* name;
  const char* generator;
  std::size_t eye_hits;
  double shadow_rays, shadow_hits, secondary_rays, secondary_hits;
  double tolerance;
};

void PrintTo(const Counted& c, std::ostream* out) { *out << c.name; }

class RayTreeCounts : public testing::TestWithParam<Counted> {};

TEST_P(RayTreeCounts, AreThoseOfAnotherProgram) {
  const Counted& c = GetParam();
  const auto accelerator = build(std::make_shared<const Scene>(generate_scene(c.generator)), "bvh");
  constexpr std::size_t kEyeRays = 513 * 513;
  const Workload tree = make_workload(WorkloadKind::whitted, *accelerator,
                                      {*accelerator->scene().data().view, kEyeRays, 1});
  std::vector<Hit> hits(tree.closest.size());
  accelerator->closest_hit(make_batch(tree.closest), hits);
  std::vector<std::uint8_t> hidden(tree.any.size());
  accelerator->any_hit(make_batch(tree.any), hidden);

  const auto is_hit = [](const Hit& hit) { return hit.is_hit(); };
  const auto eye_end = hits.begin() + kEyeRays;
  EXPECT_EQ(static_cast<std::size_t>(std::count_if(hits.begin(), eye_end, is_hit)), c.eye_hits);
  const auto expect_near = [&](double got, double expected) {
    EXPECT_NEAR(got, expected, c.tolerance * expected);
  };
  expect_near(double(tree.any.size()), c.shadow_rays);
  expect_near(double(std::count(hidden.begin(), hidden.end(), 1)), c.shadow_hits);
  expect_near(double(tree.closest.size() - kEyeRays), c.secondary_rays);
  expect_near(double(std::count_if(eye_end, hits.end(), is_hit)), c.secondary_hits);
}

INSTANTIATE_TEST_SUITE_P(
    StandardScenes, RayTreeCounts,
    testing::Values(Counted{"balls", "balls:4", 263169, 954971, 287384, 175921, 126753, 0.01},
                    Counted{"gears", "gears:4", 245332, 2126703, 840011, 506379, 384046, 0.01},
                    Counted{"lattice", "lattice:12", 261170, 1163406, 926881, 237005, 175456, 0.01},
                    Counted{"mount", "mount:6", 173686, 363265, 77087, 712356, 476908, 0.01},
                    Counted{"rings", "rings:7", 263169, 1084970, 515841, 315863, 179785, 0.01},
                    Counted{"teapot", "teapot:12", 161546, 409579, 38926, 226314, 67732, 0.01},
                    Counted{"tetra", "tetra:6", 49950, 46261, 5557, 0, 0, 0.01},
                    Counted{"tree", "tree:11", 169909, 1097835, 43396, 0, 0, 0.01}),
    [](const auto& i) { return std::string(i.param.name); });

}  // namespace
}  // namespace strahl
