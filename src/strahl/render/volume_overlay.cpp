#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include <strahl/render/camera.h>
#include <strahl/render/heat_map.h>
#include <strahl/render/volume_overlay.h>

namespace strahl {
namespace {

constexpr int kFiner = 2;  ///< rays per pixel along a side
constexpr double kTint = 0.5, kLine = 0.85;
/// Cosine of the angle by which normals of neighbours differ at an edge.
constexpr double kEdge = 0.97;

/// Hues far apart for numbers that follow each other.
Vec3d color_of(std::uint32_t node) {
  const double turn = std::fmod(0.618033988749895 * (node + 1.0), 1.0);
  const auto channel = [&](double shift) {
    return 0.55 + 0.45 * std::cos(6.283185307179586 * (turn + shift));
  };
  return {channel(0.0), channel(1.0 / 3.0), channel(2.0 / 3.0)};
}

class Overlay {
 public:
  Overlay(const Accelerator& accelerator, const View& view, int depth)
      : accelerator_(accelerator),
        depth_(depth),
        camera_(finer(view)),
        width_(camera_.width()),
        height_(camera_.height()),
        step_(length(camera_.through(1, 0).dir - camera_.through(0, 0).dir)),
        entries_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

  void find(const BuildContext& context) {
    std::atomic<int> done{0};
    context.executor.parallel_for(
        0, static_cast<std::size_t>(height_), 8, [&](std::size_t from, std::size_t to) {
          context.check(static_cast<double>(done) / height_, "volumes");
          for (int y = static_cast<int>(from); y < static_cast<int>(to); ++y, ++done)
            for (int x = 0; x < width_; ++x)
              entries_[index(x, y)] =
                  accelerator_.first_volume(camera_.through(x + 0.5, y + 0.5), depth_);
        });
  }

  void draw(Image& image) const {
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
            static_cast<std::size_t>(x);
        Vec3d below;
        for (int c = 0; c < 3; ++c)
          below[c] = static_cast<double>(image.rgb[3 * pixel + static_cast<std::size_t>(c)]);
        set_pixel(image, pixel, over(below, kFiner * x, kFiner * y));
      }
  }

 private:
  static View finer(View view) {
    view.width *= kFiner, view.height *= kFiner;
    return view;
  }

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  /// Of the nearest point of the picture.
  const VolumeEntry& at(int x, int y) const {
    return entries_[index(std::clamp(x, 0, width_ - 1), std::clamp(y, 0, height_ - 1))];
  }

  /// Mean over the rays of a pixel.
  Vec3d over(const Vec3d& below, int left, int top) const {
    Vec3d sum;
    for (int y = top; y < top + kFiner; ++y)
      for (int x = left; x < left + kFiner; ++x) sum = sum + shade(below, x, y);
    return sum / static_cast<double>(kFiner * kFiner);
  }

  Vec3d shade(const Vec3d& below, int x, int y) const {
    const bool is_line = is_edge(x, y, kFiner, 0) || is_edge(x, y, 0, kFiner);
    const VolumeEntry& entry = at(x, y);
    if (is_line) return (1.0 - kLine) * below;
    if (!entry.is_entered()) return below;
    const Vec3d light = normalized(Vec3d{0.4, 0.8, -0.6});
    const double lit = 0.6 + 0.4 * std::abs(dot(normal(x, y), light));
    return (1.0 - kTint) * below + kTint * lit * color_of(entry.node);
  }

  bool is_edge(int x, int y, int dx, int dy) const {
    const VolumeEntry &here = at(x, y), &there = at(x + dx, y + dy);
    if (here.node != there.node) return true;
    return here.is_entered() && dot(normal(x, y), normal(x + dx, y + dy)) < kEdge;
  }

  /// Of the face, in the camera's directions (right, up, forward).
  Vec3d normal(int x, int y) const {
    const double right = slope(x, y, 1, 0) / step_, up = -slope(x, y, 0, 1) / step_;
    const double column = (x + 0.5 - 0.5 * width_) * step_, row = (0.5 * height_ - y - 0.5) * step_;
    return normalized(Vec3d{right, up, 1.0 / at(x, y).t - column * right - row * up});
  }

  /// Of 1/t per point of the picture, on the side where the volume goes on.
  double slope(int x, int y, int dx, int dy) const {
    const VolumeEntry &before = at(x - dx, y - dy), &here = at(x, y), &after = at(x + dx, y + dy);
    if (after.node == here.node && &after != &here) return 1.0 / after.t - 1.0 / here.t;
    if (before.node == here.node) return 1.0 / here.t - 1.0 / before.t;
    return 0.0;
  }

  const Accelerator& accelerator_;
  int depth_;
  Camera camera_;
  int width_, height_;
  double step_;  ///< between neighbours, at distance 1
  std::vector<VolumeEntry> entries_;
};

}  // namespace

void draw_volumes(const Accelerator& accelerator, const View& view, int depth, Image& image,
                  const BuildContext& context) {
  Overlay overlay(accelerator, view, depth);
  overlay.find(context);
  overlay.draw(image);
}

}  // namespace strahl
