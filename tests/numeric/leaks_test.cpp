// No ray leaves a closed sphere unseen, twice or on the wrong side, wherever it is aimed and
// however far from the origin the sphere lies. strahl_leaks prints the same table with more rays.
#include <bench/leak_cases.h>
#include <string>
#include <tests/support/queries.h>

#include <gtest/gtest.h>

namespace strahl::leaks {
namespace {

constexpr std::size_t kRays = 5000, kBruteForceRays = 100;

class Leaks : public testing::TestWithParam<Sphere> {};

TEST_P(Leaks, EveryRayFromInsideCrossesTheSurfaceExactlyOnce) {
  const auto scene = test::scene_of(make_mesh_of(GetParam()));
  const TriangleMesh& mesh = scene->geometries().front().mesh;
  for (const auto& structure : test::build_all(scene)) {
    for (const Aim aim : kAims) {
      SCOPED_TRACE(structure->spec() + " at " + name_of(aim));
      const std::size_t count = structure->spec() == "brute_force" ? kBruteForceRays : kRays;
      const Tally sum = tally(*structure, make_rays(GetParam(), mesh, aim, count));
      EXPECT_EQ(sum.rays, count);
      EXPECT_EQ(sum.leaks, 0u);
      EXPECT_EQ(sum.wrong_counts, 0u);
      EXPECT_EQ(sum.wrong_parities, 0u);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Spheres, Leaks, testing::ValuesIn(kSpheres),
                         [](const testing::TestParamInfo<Sphere>& i) {
                           return "Number" + std::to_string(i.index);
                         });

}  // namespace
}  // namespace strahl::leaks
