#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/render/heat_map.h>
#include <strahl/render/render.h>
#include <strahl/render/tile.h>

namespace strahl {
namespace {

constexpr int kTile = 32;
constexpr int kMaxSamples = 65536;
constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 28;
/// Reach of ambient occlusion, as a share of the scene's diagonal.
constexpr double kOcclusionReach = 0.12;

constexpr std::array<std::pair<std::string_view, RenderMode>, 8> kModes{
    {{"shaded", RenderMode::shaded},
     {"normals", RenderMode::normals},
     {"depth", RenderMode::depth},
     {"ao", RenderMode::ao},
     {"path", RenderMode::path},
     {"cost", RenderMode::cost},
     {"steps", RenderMode::steps},
     {"tests", RenderMode::tests}}};

Image make_image(const RenderOptions& options, const BuildContext& context) {
  Image image;
  image.width = options.view.width + options.corners;
  image.height = options.view.height + options.corners;
  const auto pixels =
      static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
  if (pixels > kMaxPixels) throw Error(ErrorCode::usage, "more than 2^28 pixels", "image");
  const std::uint64_t per_pixel = options.channels ? 44 : 16;
  context.require_memory(pixels * per_pixel, "image");
  image.rgb.assign(3 * pixels, 0.0f);
  if (!options.channels) return image;
  for (const char* name : {"Z", "N.X", "N.Y", "N.Z"})
    image.float_channels.push_back({name, std::vector<float>(pixels)});
  for (const char* name : {"primitive_id", "geometry_id", "instance_id"})
    image.uint_channels.push_back({name, std::vector<std::uint32_t>(pixels)});
  return image;
}

/// Least and largest of the finite values; zeros where there are none.
std::pair<double, double> span_of(const std::vector<float>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const float v : values)
    if (std::isfinite(v)) low = std::min(low, double{v}), high = std::max(high, double{v});
  return low <= high ? std::pair(low, high) : std::pair(0.0, 0.0);
}

/// Near surfaces are bright; nothing is black.
Vec3d depth_color(double depth, double nearest, double farthest) {
  if (!std::isfinite(depth)) return {};
  const double range = farthest - nearest;
  return Vec3d::all(range > 0.0 ? 1.0 - 0.95 * (depth - nearest) / range : 1.0);
}

void color_depth(RenderResult& result) {
  const auto [low, high] = span_of(result.values);
  result.value_min = low, result.value_max = high;
  for (std::size_t pixel = 0; pixel < result.values.size(); ++pixel)
    set_pixel(result.image, pixel, depth_color(result.values[pixel], low, high));
}

void color_heat(RenderResult& result) {
  result.value_max = heat_scale(result.values);
  result.image.rgb = heat_map(result.values, result.value_max);
}

double diagonal(const Scene& scene) {
  return scene.total_bounds().is_empty() ? 1.0 : length(scene.total_bounds().extent());
}

}  // namespace

std::optional<RenderMode> render_mode(std::string_view name) {
  for (const auto& [word, mode] : kModes)
    if (word == name) return mode;
  return std::nullopt;
}

int sample_count(const RenderOptions& options) {
  if (options.corners || shows_one_number(options.mode)) return 1;
  if (options.samples > 0) return options.samples;
  return options.mode == RenderMode::path ? 32 : 4;
}

RenderResult render(const Accelerator& accelerator, const RenderOptions& options,
                    const BuildContext& context) {
  if (options.samples < 0 || options.samples > kMaxSamples)
    throw Error(ErrorCode::usage, "expected 1.." + std::to_string(kMaxSamples), "samples");
  const Camera camera(options.view);
  const Look look(accelerator.scene(), camera, options.up);
  RenderResult result;
  result.image = make_image(options, context);
  const int width = result.image.width, height = result.image.height;
  result.values.resize(shows_one_number(options.mode) ? result.image.rgb.size() / 3 : 0);
  const TileScene tile_scene{accelerator, options, camera, look,
                             kOcclusionReach * diagonal(accelerator.scene())};

  const int columns = (width + kTile - 1) / kTile, rows = (height + kTile - 1) / kTile;
  const auto tiles = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  std::mutex mutex;
  RayStats stats;
  std::size_t done = 0;
  context.executor.parallel_for(0, tiles, 1, [&](std::size_t first, std::size_t) {
    const int x = static_cast<int>(first % static_cast<std::size_t>(columns)) * kTile;
    const int y = static_cast<int>(first / static_cast<std::size_t>(columns)) * kTile;
    const RayStats part =
        TileRenderer(tile_scene, result.image, result.values)
            .render({x, y, std::min(x + kTile, width), std::min(y + kTile, height)});
    double fraction = 0.0;
    {
      const std::lock_guard lock(mutex);
      stats.add(part);
      fraction = static_cast<double>(++done) / static_cast<double>(tiles);
    }
    context.check(fraction, "rendering");
  });
  result.primary_rays = stats.primary_rays, result.primary_hits = stats.primary_hits;
  result.rays = stats.rays, result.hits = stats.hits;
  if (shows_one_number(options.mode))
    options.mode == RenderMode::depth ? color_depth(result) : color_heat(result);
  return result;
}

}  // namespace strahl
