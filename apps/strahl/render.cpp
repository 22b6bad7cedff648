// apps/strahl/render.cpp - `strahl render`: pictures as PNG or EXR.
#include <apps/strahl/arguments.h>
#include <apps/strahl/commands.h>
#include <apps/strahl/interrupt.h>
#include <apps/strahl/render_setup.h>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/core.h>

#include <strahl/base/hash.h>
#include <strahl/base/timer.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/exr.h>
#include <strahl/io/png.h>
#include <strahl/io/text_cursor.h>
#include <strahl/render/framing.h>
#include <strahl/render/volume_overlay.h>

namespace strahl::cli {

Format output_format(const RenderArguments& arguments) {
  if (arguments.output.empty()) {
    if (arguments.json) return Format::none;
    throw Error(ErrorCode::usage, "needed, or --json to only measure", "--output");
  }
  const std::filesystem::path path(arguments.output);
  if (!path.parent_path().empty() && !std::filesystem::is_directory(path.parent_path()))
    throw Error(ErrorCode::resource, "no such folder", path.parent_path().string());
  const std::string extension = to_lower(path.extension().string());
  if (extension == ".png") return Format::png;
  if (extension == ".exr") return Format::exr;
  throw Error(ErrorCode::usage, "expected a name ending in .png or .exr", arguments.output);
}

namespace {

ImageSize image_size(const RenderArguments& arguments, const Scene& scene) {
  if (!arguments.size.empty()) return parse_image_size(arguments.size, "--size");
  if (scene.data().view) return {scene.data().view->width, scene.data().view->height};
  return {800, 600};
}

}  // namespace

RenderOptions make_options(const RenderArguments& arguments, const Scene& scene, Format format) {
  const auto mode = render_mode(arguments.mode);
  if (!mode) throw Error(ErrorCode::usage, "unknown mode '" + arguments.mode + "'", "--mode");
  const ImageSize size = image_size(arguments, scene);
  RenderOptions options;
  options.mode = *mode;
  options.samples = arguments.samples, options.seed = arguments.seed;
  options.corners = arguments.corners, options.channels = format == Format::exr;
  options.view = default_view(scene, size.width, size.height);
  if (!arguments.from.empty()) options.view.from = parse_vector(arguments.from, "--from");
  if (!arguments.at.empty()) options.view.at = parse_vector(arguments.at, "--at");
  if (!arguments.up.empty()) options.view.up = parse_vector(arguments.up, "--up");
  if (arguments.fov) options.view.fov_degrees = *arguments.fov;
  options.up = scene.data().view ? options.view.up : guess_up(scene);
  return options;
}

void write_image(const std::string& path, Format format, const Image& image) {
  const OwnsOutput owns_output;
  if (format == Format::png) write_png(path, image);
  if (format == Format::exr) write_exr(path, image);
}

namespace {

Json report(const RenderArguments& arguments, const Accelerator& accelerator,
            const RenderOptions& options, const RenderResult& result, double seconds) {
  const auto rays = static_cast<double>(result.rays);
  Json json = {{"scene", arguments.scene},
               {"structure", accelerator.spec()},
               {"mode", arguments.mode},
               {"width", result.image.width},
               {"height", result.image.height},
               {"samples", sample_count(options)},
               {"view",
                {{"from", to_json(options.view.from)},
                 {"at", to_json(options.view.at)},
                 {"up", to_json(options.view.up)},
                 {"fov", options.view.fov_degrees}}},
               {"primary_rays", result.primary_rays},
               {"primary_hits", result.primary_hits},
               {"rays", result.rays},
               {"hits", result.hits},
               {"build_seconds", accelerator.report().seconds},
               {"seconds", seconds},
               {"mrays_per_second", seconds > 0.0 ? rays / seconds * 1e-6 : 0.0}};
  if (result.value_max > 0.0)
    json["values"] = {{"min", result.value_min}, {"max", result.value_max}};
  json["output"] = arguments.output.empty() ? Json(nullptr) : Json(arguments.output);
  return json;
}

/// About how many rays of which kind a picture takes, for the advisor.
AdviceOptions rays_of(const RenderOptions& options) {
  AdviceOptions rays;
  rays.view = options.view;
  const bool is_path = options.mode == RenderMode::path;
  rays.workload = is_path                          ? WorkloadKind::diffuse
                  : options.mode == RenderMode::ao ? WorkloadKind::ao
                                                   : WorkloadKind::primary;
  constexpr double kRaysPerPath = 6.0;
  rays.rays = static_cast<double>(options.view.width) * options.view.height *
              sample_count(options) * (is_path ? kRaysPerPath : 2.0);
  return rays;
}

int run_render(const RenderArguments& arguments) {
  const Format format = output_format(arguments);
  Session session(arguments);
  const std::shared_ptr<const Scene> scene = session.load(arguments.scene);
  const RenderOptions options = make_options(arguments, *scene, format);
  const std::unique_ptr<Accelerator> accelerator = session.build(
      scene, arguments.spec.empty() ? std::string(kDefaultSpec) : arguments.spec, rays_of(options));
  const Timer timer;
  RenderResult result = render(*accelerator, options, session.context());
  const double seconds = timer.seconds();
  if (arguments.volumes >= 0)
    draw_volumes(*accelerator, options.view, arguments.volumes, result.image, session.context());
  session.finish_progress();
  write_image(arguments.output, format, result.image);
  if (arguments.json) {
    print_json(report(arguments, *accelerator, options, result, seconds));
  } else {
    print_text(
        fmt::format("{}: {} x {}, {} rays in {:.2f} s ({:.2f} million/s), {:.1f} % of the "
                    "primary rays hit\n",
                    arguments.output, result.image.width, result.image.height, result.rays, seconds,
                    static_cast<double>(result.rays) / seconds * 1e-6,
                    100.0 * static_cast<double>(result.primary_hits) /
                        static_cast<double>(result.primary_rays)));
  }
  return kExitOk;
}

void add_view_options(CLI::App& command, RenderArguments& arguments) {
  command.add_option("--from", arguments.from, "Position of the eye")->type_name("X,Y,Z");
  command.add_option("--at", arguments.at, "Point looked at")->type_name("X,Y,Z");
  command.add_option("--up", arguments.up, "Direction upwards")->type_name("X,Y,Z");
  command.add_option("--fov", arguments.fov, "Full vertical angle of view")->type_name("DEG");
  command.add_option("--size", arguments.size, "Size (default: the scene's, else 800x600)")
      ->type_name("WxH");
}

void add_volume_option(CLI::App& command, RenderArguments& arguments) {
  command
      .add_option("--volumes", arguments.volumes,
                  "Draw the bounding volumes of the nodes at that depth (bvh only)")
      ->type_name("DEPTH")
      ->check(CLI::Range(0, 64))
      ->excludes(command.get_option("--corners"))
      ->excludes(command.get_option("--frames"));
}

void add_frame_options(CLI::App& command, RenderArguments& arguments) {
  command.add_option("--frames", arguments.frames, "Render that many pictures of an animation")
      ->type_name("N")
      ->check(CLI::Range(1, 10'000));
  CLI::Option* frames = command.get_option("--frames");
  command
      .add_option("--motion", arguments.motion, "Motion (docs/motion.md) instead of the scene's")
      ->type_name("JSON")
      ->needs(frames);
  command.add_option("--animation", arguments.animation, "Which of the scene's (default: first)")
      ->type_name("NAME")
      ->needs(frames);
  command
      .add_flag("--verify", arguments.verify,
                "Compare every frame with bvh built anew, five with brute force")
      ->needs(frames);
}

}  // namespace

void add_render_command(CLI::App& app, Runner& run) {
  CLI::App* command = app.add_subcommand("render", "Render a picture of a scene");
  command->footer(
      "Modes: shaded (material colours, lamps, soft occlusion), normals, depth (near is bright),\n"
      "ao (ambient occlusion), path (diffuse light transport under a sky); heat maps per ray:\n"
      "steps (traversal), tests (of primitives), cost (both and tests of bounding volumes).\n"
      "The view is that of the scene, else one that frames it; each part can be overridden.\n"
      "EXR files also hold depth (Z), normals (N.X, N.Y, N.Z) and primitive_id, geometry_id,\n"
      "instance_id of the pixels' centres. The picture does not depend on structure and threads.\n"
      "With --volumes the bounding volumes of a level of a bvh lie over the picture.\n"
      "With --frames the scene moves, from the start to the end of its animation or of a motion\n"
      "file; two_level only updates what moves, bvh is fitted to it and to what skins and morph\n"
      "targets deform, other structures are built anew for each frame.\n"
      "Examples:\n"
      "  strahl render bunny.ply -o bunny.png --size 1024x768\n"
      "  strahl render robot.glb -o robot.exr --mode path --spp 64\n"
      "  strahl render gen:balls:4 --corners --mode depth --json\n"
      "  strahl render teapot.obj -o teapot.png --structure bvh:bv=obb --volumes 4\n"
      "  strahl render robot.glb -o robot.png --frames 100      (robot_0000.png ...)\n"
      "  strahl render city.glb -o city.png --frames 100 --motion cars.json --verify");
  auto arguments = std::make_shared<RenderArguments>();
  command->add_option("scene", arguments->scene, kSceneHelp)->required()->type_name("SCENE");
  command->add_option("-o,--output", arguments->output, "Picture, .png or .exr")->type_name("FILE");
  command->add_option("--structure", arguments->spec, kSpecHelp)->type_name("SPEC");
  command->add_option("--mode", arguments->mode, "What to show (default: shaded)")
      ->type_name("MODE");
  command->add_option("--spp", arguments->samples, "Samples per pixel")
      ->type_name("N")
      ->check(CLI::Range(1, 65536));
  command->add_option("--seed", arguments->seed, "Seed of the samples")->type_name("N");
  command->add_flag("--corners", arguments->corners,
                    "One ray per pixel corner, (W+1)x(H+1): the test image of the SPD scenes");
  add_view_options(*command, *arguments);
  add_common_options(*command, *arguments);
  add_frame_options(*command, *arguments);
  add_volume_option(*command, *arguments);
  command->callback([=, &run] {
    run = [=] { return arguments->frames > 0 ? run_frames(*arguments) : run_render(*arguments); };
  });
}

}  // namespace strahl::cli
