#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>
#include <strahl/render/volume_overlay.h>

namespace strahl {
namespace {

using ScenePtr = std::shared_ptr<const Scene>;

ScenePtr balls(std::vector<Sphere> spheres) {
  SceneData data;
  data.geometries.resize(1);
  data.geometries[0].kind = PrimitiveKind::sphere;
  data.geometries[0].spheres = std::move(spheres);
  return std::make_shared<const Scene>(std::move(data));
}

/// From +z, one unit high at distance 1.
View front_view(const Vec3d& from) {
  const double degrees = 2.0 * std::atan(0.5) * 180.0 / std::numbers::pi;
  return {from, {0, 0, 0}, {0, 1, 0}, degrees, 120, 120};
}

Image drawn(const Accelerator& accelerator, const View& view, int depth,
            const BuildContext& context = {}) {
  Image image{view.width, view.height, std::vector<float>(3 * 120 * 120, 0.5f), {}, {}};
  draw_volumes(accelerator, view, depth, image, context);
  return image;
}

Vec3d color(const Image& image, int x, int y) {
  const std::size_t at = 3 * static_cast<std::size_t>(y * image.width + x);
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

double covered(const Image& image) {
  int count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) count += color(image, x, y) != Vec3d::all(0.5);
  return static_cast<double>(count) / (image.width * image.height);
}

TEST(FirstVolume, IsEnteredWhereTheVolumeBegins) {
  const ScenePtr scene = balls({{{0, 0, 0}, 1.0}});
  for (const char* spec : {"bvh", "bvh:bv=sphere", "bvh:bv=obb", "bvh:bv=auto"}) {
    const auto bvh = build(scene, spec);
    const VolumeEntry entry = bvh->first_volume({{0, 0, 5}, {0, 0, -2}}, 0);
    EXPECT_EQ(entry.node, 0u) << spec;
    EXPECT_NEAR(entry.t, 2.0, 1e-5) << spec;
    EXPECT_FALSE(bvh->first_volume({{0, 3, 5}, {0, 0, -2}}, 0).is_entered()) << spec;
    EXPECT_FALSE(bvh->first_volume({{0, 0, 0.5}, {0, 0, -2}}, 0).is_entered()) << spec;
  }
}

TEST(FirstVolume, IsTheNearestOfTheLevel) {
  const ScenePtr scene = balls({{{0, 0, 0}, 1.0}, {{0, 0, -9}, 1.0}, {{0, 0, 9}, 1.0}});
  const auto bvh = build(scene, "bvh:leaf_size=1");
  const Ray ray{{0, 0, 5}, {0, 0, -1}};
  EXPECT_FALSE(bvh->first_volume(ray, 0).is_entered());  // it begins inside
  EXPECT_NEAR(bvh->first_volume(ray, 2).t, 4.0, 1e-5);
  EXPECT_EQ(bvh->first_volume(ray, 2).node, bvh->first_volume(ray, 60).node);
}

TEST(FirstVolume, IsUnsupportedByWhatHasNone) {
  const ScenePtr scene = balls({{{0, 0, 0}, 1.0}});
  try {
    build(scene, "grid")->first_volume({{0, 0, 5}, {0, 0, -1}}, 0);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::unsupported);
  }
  SceneData nothing;
  const auto empty = std::make_shared<const Scene>(std::move(nothing));
  EXPECT_FALSE(build(empty, "bvh")->first_volume({{0, 0, 5}, {0, 0, -1}}, 0).is_entered());
}

TEST(VolumeOverlay, CoversWhatTheVolumeCovers) {
  const ScenePtr scene = balls({{{0, 0, 0}, 1.0}});
  const View view = front_view({0, 0, 5});
  // The near face of the box fills the middle half of the picture.
  EXPECT_NEAR(covered(drawn(*build(scene, "bvh"), view, 0)), 0.25, 0.02);
  const double radius = 1.0 / std::sqrt(24.0);
  EXPECT_NEAR(covered(drawn(*build(scene, "bvh:bv=sphere"), view, 0)),
              std::numbers::pi * radius * radius, 0.01);
}

TEST(VolumeOverlay, ShadesFacesAlikeAndApart) {
  const auto bvh = build(balls({{{0, 0, 0}, 1.0}}), "bvh");
  const Image image = drawn(*bvh, front_view({4, 3, 5}), 0);
  const Vec3d front = color(image, 45, 70), front_again = color(image, 55, 80),
              right = color(image, 80, 65), top = color(image, 60, 40);
  EXPECT_LT(norm_max(front - front_again), 1e-5);
  EXPECT_GT(norm_max(front - right), 0.01);
  EXPECT_GT(norm_max(front - top), 0.01);
  EXPECT_GT(norm_max(right - top), 0.01);
}

TEST(VolumeOverlay, GivesVolumesColoursAndLines) {
  const auto bvh = build(balls({{{-1, 0, 0}, 0.5}, {{1, 0, 0}, 0.5}}), "bvh:leaf_size=1");
  const View view = front_view({0, 0, 5});
  const Image one = drawn(*bvh, view, 0), two = drawn(*bvh, view, 1);
  EXPECT_LT(norm_max(color(one, 33, 60) - color(one, 87, 60)), 1e-5);
  EXPECT_GT(norm_max(color(two, 33, 60) - color(two, 87, 60)), 0.05);
  EXPECT_EQ(color(two, 60, 60), Vec3d::all(0.5));
  EXPECT_EQ(two.rgb, drawn(*bvh, view, 9).rgb);
  double darkest = 1.0;
  for (int x = 0; x < 120; ++x) darkest = std::min(darkest, norm1(color(two, x, 60)) / 3.0);
  EXPECT_LT(darkest, 0.3);
}

TEST(VolumeOverlay, IsTheSameForAnyNumberOfThreadsAndCanBeCancelled) {
  const auto bvh = build(balls({{{0, 0, 0}, 1.0}, {{1, 1, 0}, 0.5}}), "bvh:leaf_size=1");
  const View view = front_view({0, 0, 5});
  BuildContext context;
  if (Executor::threads_available()) context.executor = Executor::with_threads(2);
  EXPECT_EQ(drawn(*bvh, view, 1).rgb, drawn(*bvh, view, 1, context).rgb);
  context.progress = [](double, std::string_view) { return false; };
  EXPECT_THROW(drawn(*bvh, view, 1, context), Error);
}

}  // namespace
}  // namespace strahl
