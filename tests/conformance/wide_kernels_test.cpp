// wide_bvh with every instruction set of the machine and both widths, against brute force on the
// adversarial scenes and against bvh with many rays on larger ones: the same bits.
#include <cmath>
#include <tests/conformance/float_ray_set.h>
#include <tests/conformance/forced_isa.h>
#include <tests/conformance/oracle.h>
#include <tests/conformance/scenes.h>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/base/rng.h>
#include <strahl/io/load.h>
#include <strahl/structures/wide_bvh/wide_kernel.h>

namespace strahl::test {
namespace {

const std::size_t kRays = is_full_run() ? 3000 : 170;
const std::size_t kManyRays = is_full_run() ? 1'000'000 : is_smoke_run() ? 2'000 : 20'000;

class WideKernels : public testing::TestWithParam<std::string> {};

TEST_P(WideKernels, AnswerLikeBruteForceWithEitherWidth) {
  const ForcedIsa forced(GetParam().c_str());
  for (const NamedScene& named : adversarial_scenes()) {
    const Expected expected = expected_answers(scene_of(named), kRays, 5);
    for (const char* spec : {"wide_bvh:width=8", "wide_bvh:width=16"})
      ASSERT_EQ(first_difference(scene_of(named), spec, expected), "") << named.name << ' ' << spec;
  }
}

/// Rays at corners, along edges, in planes, from surfaces and from afar, too many for brute force.
TEST_P(WideKernels, AnswerLikeBvhOnLargeScenes) {
  const ForcedIsa forced(GetParam().c_str());
  for (const char* name : {"gen:icosphere:5", "gen:soup:20000", "gen:terrain:64"}) {
    const auto scene = std::make_shared<const Scene>(load_scene_data(name));
    const RaySet set = adversarial_rays(*scene, kManyRays, 77);
    const auto bvh = build(scene, "bvh");
    std::vector<Hit> expected(set.rays.size()), got(set.rays.size());
    std::vector<std::uint8_t> any(set.rays.size());
    bvh->closest_hit(set.batch(false), expected);
    for (const char* spec : {"wide_bvh:width=8", "wide_bvh:width=16"}) {
      const auto wide = build(scene, spec);
      wide->closest_hit(set.batch(false), got);
      wide->any_hit(set.batch(false), any);
      for (std::size_t i = 0; i < got.size(); ++i) {
        ASSERT_TRUE(have_same_bits(got[i], expected[i])) << name << ' ' << spec << " ray " << i;
        ASSERT_EQ(any[i] != 0, expected[i].is_hit()) << name << ' ' << spec << " ray " << i;
      }
    }
  }
}

TEST_P(WideKernels, AnswerFloatRaysLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  for (const char* name : {"gen:icosphere:4", "gen:soup:3000", "gen:terrain:32"}) {
    const auto scene = std::make_shared<const Scene>(load_scene_data(name));
    SCOPED_TRACE(name);
    expect_like_bvh(scene, FloatRaySet(adversarial_rays(*scene, kManyRays, 78)),
                    {"wide_bvh:width=8", "wide_bvh:width=8,batch=single", "wide_bvh:width=16",
                     "wide_bvh:quality=high"});
  }
}

/// Rays that run close together are traced as packets.
TEST_P(WideKernels, AnswerBundlesOfFloatRaysLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  for (const char* name : {"gen:icosphere:4", "gen:soup:3000", "gen:terrain:32"}) {
    const auto scene = std::make_shared<const Scene>(load_scene_data(name));
    SCOPED_TRACE(name);
    expect_like_bvh(scene, FloatRaySet::bundles(adversarial_rays(*scene, kManyRays, 79), 80),
                    {"wide_bvh:width=8", "wide_bvh:width=8,batch=single", "wide_bvh:width=16"});
  }
}

/// Two slanting sheets that only doubles tell apart: corners of the second are the next floats.
std::shared_ptr<const Scene> close_sheets() {
  constexpr std::uint32_t kSide = 24;
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (int sheet = 0; sheet < 2; ++sheet) {
    const auto base = static_cast<std::uint32_t>(vertices.size());
    for (std::uint32_t i = 0; i <= kSide; ++i)
      for (std::uint32_t j = 0; j <= kSide; ++j) {
        const double x = i / double{kSide}, y = j / double{kSide};
        const float z = static_cast<float>(0.3 * x + 0.2 * y + 0.5);
        vertices.push_back({static_cast<float>(x), static_cast<float>(y),
                            sheet == 0 ? z : std::nextafter(z, 2.0f)});
        if (i == kSide || j == kSide) continue;
        const std::uint32_t a = base + i * (kSide + 1) + j, b = a + kSide + 1;
        indices.insert(indices.end(), {a, a + 1, b + 1, a, b + 1, b});
      }
  }
  SceneData data;
  data.geometries.emplace_back().mesh = make_mesh(std::move(vertices), std::move(indices));
  return std::make_shared<const Scene>(std::move(data));
}

TEST_P(WideKernels, TellCloseSheetsApartLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  const auto scene = close_sheets();
  const RaySet set = adversarial_rays(*scene, kManyRays, 81);
  for (const FloatRaySet& rays : {FloatRaySet::fans(set, *scene, 6), FloatRaySet::bundles(set, 82)})
    expect_like_bvh(scene, rays, {"wide_bvh:width=8", "wide_bvh:width=16"});
}

/// What packets and flights share out between them.
TEST_P(WideKernels, AnswerFansOfFloatRaysLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  for (const char* name : {"gen:icosphere:5", "gen:soup:20000", "gen:terrain:64"}) {
    const auto scene = std::make_shared<const Scene>(load_scene_data(name));
    const RaySet set = adversarial_rays(*scene, kManyRays, 80);
    SCOPED_TRACE(name);
    expect_like_bvh(scene, FloatRaySet::fans(set, *scene, 5),
                    {"wide_bvh:width=8", "wide_bvh:width=16", "wide_bvh:quality=high"});
  }
}

/// Tiles of a floor that only fill a few blocks.
std::shared_ptr<const Scene> floor_of_tiles() {
  constexpr std::uint32_t kSide = 4;
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i <= kSide; ++i)
    for (std::uint32_t j = 0; j <= kSide; ++j) {
      vertices.push_back({i - 2.0, j - 2.0, 0.0});
      if (i == kSide || j == kSide) continue;
      const std::uint32_t a = i * (kSide + 1) + j, b = a + kSide + 1;
      indices.insert(indices.end(), {a, a + 1, b + 1, a, b + 1, b});
    }
  SceneData data;
  data.geometries.emplace_back().mesh = make_mesh(std::move(vertices), std::move(indices));
  return std::make_shared<const Scene>(std::move(data));
}

/// Blocks of 64 rays from one point above the floor, some down to it, some beyond the horizon: det
/// of a triangle has both signs.
FloatRaySet around_the_horizon(std::uint64_t seed) {
  FloatRaySet out;
  Rng rng(seed);
  for (int block = 0; block < 400; ++block) {
    const double height = std::ldexp(1.0, -static_cast<int>(rng.below(8)));
    const Vec3f org(Vec3d{rng.uniform(-2, 2), rng.uniform(-2, 2), height});
    const double angle = rng.uniform(0, 6.28),
                 width = std::ldexp(1.0, -static_cast<int>(rng.below(6)));
    const double up = rng.uniform(0, 2);
    for (int k = 0; k < 64; ++k) {
      const double a = angle + width * rng.uniform(-1, 1);
      out.records.push_back(
          {org, 0.0f, Vec3f(Vec3d{std::cos(a), std::sin(a), height * rng.uniform(-2, up)}), 8.0f});
    }
  }
  return out;
}

TEST_P(WideKernels, AnswerRaysAroundTheHorizonLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  expect_like_bvh(floor_of_tiles(), around_the_horizon(8),
                  {"wide_bvh:width=8", "wide_bvh:width=16"});
}

/// What packets from one point take for granted.
TEST_P(WideKernels, AnswerRaysFromPlacesLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  for (const char* name : {"gen:icosphere:1", "gen:terrain:8", "gen:soup:60", "gen:soup:2000"}) {
    const auto scene = std::make_shared<const Scene>(load_scene_data(name));
    const RaySet set = adversarial_rays(*scene, kManyRays, 83);
    SCOPED_TRACE(name);
    expect_like_bvh(scene, FloatRaySet::from_places(set, *scene, 7),
                    {"wide_bvh:width=8", "wide_bvh:width=16"});
  }
}

/// An origin that all rays share in memory, too: nothing lies behind it.
TEST_P(WideKernels, AnswerRaysOfOneStoredOriginLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  const auto scene = std::make_shared<const Scene>(load_scene_data("gen:icosphere:3"));
  const std::vector<Vec3f> org(1, Vec3f(0.1f, 0.2f, -0.3f));
  const FloatRaySet set(adversarial_rays(*scene, 500, 87));
  RayBatch batch = set.batch();
  batch.org = {reinterpret_cast<const std::byte*>(org.data()), set.records.size(), 0, false};
  batch.t_min = batch.t_max = {};
  std::vector<Hit> expected(set.records.size()), got(set.records.size());
  build(scene, "bvh")->closest_hit(batch, expected);
  build(scene, "wide_bvh")->closest_hit(batch, got);
  for (std::size_t i = 0; i < got.size(); ++i)
    ASSERT_TRUE(have_same_bits(got[i], expected[i])) << i;
}

/// Curved things and instances beside triangles of floats, too: their lanes have no corners.
TEST_P(WideKernels, AnswerFloatRaysInAdversarialScenesLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  for (const NamedScene& named : adversarial_scenes()) {
    const auto scene = scene_of(named);
    SCOPED_TRACE(named.name);
    expect_like_bvh(scene, FloatRaySet(adversarial_rays(*scene, kRays, 91)),
                    {"wide_bvh:width=8", "wide_bvh:width=16,layout=compact"});
  }
}

/// The triangles of a scene of one mesh, its vertices moved a little to where no floats are.
std::shared_ptr<const Scene> between_floats(const std::string& name) {
  const SceneData from = load_scene_data(name);
  const TriangleMesh& mesh = from.geometries.at(0).mesh;
  Rng rng(88);
  std::vector<Vec3d> vertices;
  for (std::size_t i = 0; i < mesh.vertices.count; ++i) {
    const Vec3d nudge{rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)};
    vertices.push_back(mesh.vertices[i] + nudge * 1e-9);
  }
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const IndexView::Triple t = mesh.triangles[i];
    for (const std::uint64_t corner : {t.a, t.b, t.c})
      indices.push_back(static_cast<std::uint32_t>(corner));
  }
  SceneData data;
  data.geometries.emplace_back().mesh = make_mesh(std::move(vertices), std::move(indices));
  return std::make_shared<const Scene>(std::move(data));
}

/// Blocks hold rounded corners there; the t of hits is that of the scene's own.
TEST_P(WideKernels, AnswerFloatRaysInScenesOfDoublesLikeBvh) {
  const ForcedIsa forced(GetParam().c_str());
  for (const char* name : {"gen:icosphere:4", "gen:terrain:32"}) {
    const auto scene = between_floats(name);
    const RaySet set = adversarial_rays(*scene, kManyRays, 89);
    SCOPED_TRACE(name);
    for (const FloatRaySet& rays : {FloatRaySet(set), FloatRaySet::bundles(set, 90)})
      expect_like_bvh(scene, rays, {"wide_bvh:width=8", "wide_bvh:width=16,batch=single"});
  }
}

INSTANTIATE_TEST_SUITE_P(Isa, WideKernels, testing::ValuesIn(isas()),
                         [](const testing::TestParamInfo<std::string>& i) { return i.param; });

TEST(WideKernels, UnknownInstructionSetIsAnErrorThatNamesTheKnownOnes) {
  const ForcedIsa forced("mmx");
  try {
    build(scene_of(adversarial_scenes()[1]), "wide_bvh");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    for (const std::string& isa : isas())
      EXPECT_NE(std::string(error.what()).find(isa), std::string::npos) << error.what();
  }
}

TEST(WideKernels, TheOneOfEveryProcessorIsAlwaysThere) {
  ASSERT_FALSE(wide_kernels().empty());
#if defined(__aarch64__)
  EXPECT_STREQ(wide_kernels().back()->isa, "neon");
#else
  EXPECT_STREQ(wide_kernels().back()->isa, "scalar");
#endif
}

}  // namespace
}  // namespace strahl::test
