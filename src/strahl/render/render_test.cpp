#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>
#include <strahl/render/framing.h>
#include <strahl/render/render.h>

namespace strahl {
namespace {

/// A unit sphere at the origin and a triangle beside it.
std::shared_ptr<const Scene> make_scene() {
  SceneData data;
  data.geometries.resize(2);
  data.geometries[0].kind = PrimitiveKind::sphere;
  data.geometries[0].spheres = {{{0, 0, 0}, 1.0}};
  data.geometries[1].mesh =
      make_mesh(std::vector<Vec3d>{{1, -1, 0}, {3, -1, 0}, {2, 1, 0}}, {0, 1, 2});
  data.geometries[1].geometry_id = 1;
  return std::make_shared<const Scene>(std::move(data));
}

RenderOptions small_options(const Scene& scene, RenderMode mode) {
  RenderOptions options;
  options.mode = mode;
  options.view = default_view(scene, 70, 45);
  options.channels = true;
  return options;
}

TEST(Render, PictureIsTheSameForAnyStructureAndNumberOfThreads) {
  const auto scene = make_scene();
  BuildContext two_threads;
  if (Executor::threads_available()) two_threads.executor = Executor::with_threads(2);
  for (const char* mode : {"shaded", "normals", "depth", "ao", "path"}) {
    const RenderOptions options = small_options(*scene, *render_mode(mode));
    const RenderResult first = render(*build(scene, "brute_force"), options);
    const RenderResult second = render(*build(scene, kDefaultSpec), options, two_threads);
    EXPECT_EQ(first.image.rgb, second.image.rgb) << mode;
    EXPECT_EQ(first.hits, second.hits) << mode;
    EXPECT_GT(first.primary_hits, 300u) << mode;
  }
}

TEST(Render, HeatMapsAreTheSameForAnyNumberOfThreads) {
  const auto scene = make_scene();
  const auto accelerator = build(scene, kDefaultSpec);
  BuildContext two_threads;
  if (Executor::threads_available()) two_threads.executor = Executor::with_threads(2);
  for (const RenderMode mode : {RenderMode::cost, RenderMode::steps}) {
    const RenderOptions options = small_options(*scene, mode);
    const RenderResult first = render(*accelerator, options);
    EXPECT_EQ(first.image.rgb, render(*accelerator, options, two_threads).image.rgb);
    EXPECT_GT(first.value_max, 0.0);
  }
}

TEST(Render, ChannelsTellWhatTheCentresOfThePixelsHit) {
  const auto scene = make_scene();
  RenderOptions options;
  options.channels = true;
  options.view = {{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 60.0, 33, 33};
  const Image image = render(*build(scene, "brute_force"), options).image;
  const std::size_t middle = 16 * 33 + 16, corner = 0;
  ASSERT_EQ(image.float_channels[0].name, "Z");
  EXPECT_EQ(image.float_channels[0].values[middle], 4.0f);
  EXPECT_TRUE(std::isinf(image.float_channels[0].values[corner]));
  EXPECT_EQ(image.float_channels[3].values[middle], 1.0f) << "normal towards +z";
  EXPECT_EQ(image.uint_channels[0].values[middle], 0u);
  EXPECT_EQ(image.uint_channels[1].values[corner], kNoId);
}

TEST(Render, SeedChangesThePictureAndTheSameSeedDoesNot) {
  const auto scene = make_scene();
  const auto accelerator = build(scene, kDefaultSpec);
  RenderOptions options = small_options(*scene, RenderMode::path);
  options.samples = 2;
  const Image first = render(*accelerator, options).image;
  EXPECT_EQ(render(*accelerator, options).image.rgb, first.rgb);
  options.seed = 2;
  EXPECT_NE(render(*accelerator, options).image.rgb, first.rgb);
}

TEST(Render, CornersGiveOneMoreRowAndColumn) {
  const auto scene = make_scene();
  RenderOptions options = small_options(*scene, RenderMode::depth);
  options.corners = true;
  const RenderResult result = render(*build(scene, kDefaultSpec), options);
  EXPECT_EQ(result.image.width, 71);
  EXPECT_EQ(result.primary_rays, 71u * 46u);
}

TEST(Render, ProgressReturningFalseCancels) {
  const auto scene = make_scene();
  BuildContext context;
  context.progress = [](double, std::string_view) { return false; };
  try {
    render(*build(scene, kDefaultSpec), small_options(*scene, RenderMode::normals), context);
    FAIL() << "not cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

TEST(Render, EmptySceneShowsTheBackground) {
  const auto scene = std::make_shared<const Scene>(SceneData{});
  for (const char* mode : {"shaded", "normals", "depth", "ao", "path", "cost", "steps", "tests"}) {
    const RenderResult result =
        render(*build(scene, kDefaultSpec), small_options(*scene, *render_mode(mode)));
    EXPECT_EQ(result.primary_hits, 0u) << mode;
  }
}

TEST(Render, ImageAboveTheMemoryLimitIsAnError) {
  const auto scene = make_scene();
  BuildContext context;
  context.memory_limit = 1000;
  EXPECT_THROW(
      render(*build(scene, kDefaultSpec), small_options(*scene, RenderMode::depth), context),
      Error);
}

}  // namespace
}  // namespace strahl
