// apps/strahl/render_setup.h - what pictures and animations share: arguments, view, output.
#pragma once

#include <apps/strahl/session.h>
#include <optional>

#include <strahl/render/render.h>

namespace strahl::cli {

struct RenderArguments : CommonOptions {
  std::string scene, spec, output, mode = "shaded", size;
  std::string from, at, up;
  std::optional<double> fov;
  int samples = 0;
  std::uint64_t seed = 1;
  bool corners = false;
  int volumes = -1;  ///< depth of those that are drawn; below 0: none
  int frames = 0;    ///< 0: a single picture
  std::string motion, animation;
  bool verify = false;
};

enum class Format { none, png, exr };

/// Checked before work starts, so that a typing error costs no picture.
Format output_format(const RenderArguments& arguments);
RenderOptions make_options(const RenderArguments& arguments, const Scene& scene, Format format);
void write_image(const std::string& path, Format format, const Image& image);

/// Renders the pictures of an animation; returns the exit code.
int run_frames(const RenderArguments& arguments);

}  // namespace strahl::cli
