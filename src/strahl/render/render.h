// render/render.h - pictures of a scene through any structure.
//
// The image is cut into tiles; each is traced in batches. Random numbers depend on seed, pixel and
// sample only, so the picture is the same for every structure and number of threads.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <strahl/catalog/accelerator.h>
#include <strahl/io/image.h>

namespace strahl {

/// shaded: material colours, lamps and soft occlusion; normals: as colours; depth: near is bright;
/// ao: ambient occlusion; path: diffuse light transport under a sky; steps: traversal steps and
/// leaves of the centre ray; tests: its primitive tests; cost: both and tests of bounding volumes.
enum class RenderMode { shaded, normals, depth, ao, path, cost, steps, tests };

/// The mode of that name; nothing for another word.
std::optional<RenderMode> render_mode(std::string_view name);

struct RenderOptions {
  RenderMode mode = RenderMode::shaded;
  View view;          ///< with the size of the image
  Vec3d up{0, 0, 1};  ///< of sky and ground
  int samples = 0;    ///< per pixel; 0: a good number for the mode
  std::uint64_t seed = 1;
  bool corners = false;   ///< one ray per pixel corner: (width + 1) x (height + 1) values
  bool channels = false;  ///< also Z, ids and normals of the rays through the pixels' centres
};

struct RenderResult {
  Image image;
  std::uint64_t primary_rays = 0, primary_hits = 0;
  std::uint64_t rays = 0, hits = 0;         ///< with secondary rays
  double value_min = 0.0, value_max = 0.0;  ///< what the colours of a mode of one number span
  std::vector<float> values;                ///< that number per pixel: depth, cost, steps, tests
};

/// Number of samples per pixel that options ask for. Modes of one number always have one.
int sample_count(const RenderOptions& options);

/// Renders. Throws Error: usage for an impossible view, more samples than 65536 or an image above
/// 2^28 pixels; resource above the memory limit; cancelled.
RenderResult render(const Accelerator& accelerator, const RenderOptions& options,
                    const BuildContext& context = {});

}  // namespace strahl
