// render/tile.h - one tile of a picture: its rays, batch by batch.
//
// Secondary rays exclude the primitive they start on and begin a rounding error away from it, where
// coincident copies of that primitive would lie.
// Thread safety: one object per thread.
#pragma once

#include <vector>

#include <strahl/base/rng.h>
#include <strahl/render/look.h>
#include <strahl/render/render.h>

namespace strahl {

/// Whether the mode shows one number of the ray through the centre.
constexpr bool shows_one_number(RenderMode mode) {
  return mode >= RenderMode::cost || mode == RenderMode::depth;
}

/// Pixels [x0, x1) x [y0, y1).
struct TileRect {
  int x0, y0, x1, y1;
};

struct RayStats {
  std::uint64_t primary_rays = 0, primary_hits = 0, rays = 0, hits = 0;
  void add(const RayStats& o) {
    primary_rays += o.primary_rays, primary_hits += o.primary_hits;
    rays += o.rays, hits += o.hits;
  }
};

/// What all tiles of a picture share.
struct TileScene {
  const Accelerator& accelerator;
  const RenderOptions& options;
  const Camera& camera;
  const Look& look;
  double occlusion_distance;  ///< surfaces farther away do not darken
};

class TileRenderer {
 public:
  /// values receives one number per pixel in modes that show one.
  TileRenderer(const TileScene& scene, Image& image, std::vector<float>& values);

  /// Renders the tile. Other tiles may be rendered into the same image at the same time.
  RayStats render(const TileRect& tile);

 private:
  /// A pixel's state during one sample.
  struct Path {
    std::size_t pixel;  ///< index in the image
    Vec3d throughput{1, 1, 1};
  };
  struct Queue {
    std::vector<Ray> rays;
    std::vector<PrimitiveId> excluded;
    std::vector<Path> paths;
    void clear() { rays.clear(), excluded.clear(), paths.clear(); }
    void add(const Ray& ray, const PrimitiveId& exclude, const Path& path) {
      rays.push_back(ray), excluded.push_back(exclude), paths.push_back(path);
    }
  };

  void make_primary(const TileRect& tile, int sample, int samples);
  void trace_closest();
  void shade(int sample, int samples);
  void record_channels();
  void record_value(std::size_t i);
  void occlude(int sample, int samples);
  void follow_paths(int sample);
  void bounce(std::size_t i, int sample, int depth);
  void add(std::size_t pixel, const Vec3d& color);
  Ray leaving(const SurfacePoint& point, const Vec3d& dir) const;
  Rng pixel_rng(std::size_t pixel, int sample, int purpose) const;

  const TileScene& scene_;
  Image& image_;
  std::vector<float>& values_;
  Queue queue_, next_;
  std::vector<Hit> hits_;
  std::vector<std::uint8_t> hidden_;
  RayStats stats_;
};

}  // namespace strahl
