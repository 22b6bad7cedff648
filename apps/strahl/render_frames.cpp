// apps/strahl/render_frames.cpp - `strahl render --frames`: a scene that moves, picture by picture.
#include <algorithm>
#include <apps/strahl/commands.h>
#include <apps/strahl/render_setup.h>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/core.h>

#include <strahl/base/timer.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/load.h>
#include <strahl/io/motion_file.h>
#include <strahl/measure/pose_check.h>
#include <strahl/measure/statistics.h>

namespace strahl::cli {
namespace {

constexpr std::size_t kCheckedRays = 10'000, kBruteRays = 200;
constexpr int kBruteFrames = 5;

/// What happened to one picture.
struct Frame {
  double time = 0.0;  ///< of the animation
  double pose_seconds = 0.0, update_seconds = 0.0, trace_seconds = 0.0;
  std::uint64_t rays = 0;
  std::string output;
  std::optional<PoseCheck> check;
  std::size_t brute_rays = 0;
};

const Motion& choose(const std::vector<Motion>& animations, const std::string& name,
                     const std::string& scene) {
  for (const Motion& motion : animations)
    if (name.empty() || motion.name == name) return motion;
  if (name.empty())
    throw Error(ErrorCode::bad_input, "has no animation: give one by --motion", scene);
  std::string known;
  for (const Motion& motion : animations) known += (known.empty() ? "" : ", ") + motion.name;
  throw Error(ErrorCode::usage, "no animation '" + name + "' in " + scene + "; known: " + known,
              "--animation");
}

Motion find_motion(const RenderArguments& arguments, const RiggedScene& rigged) {
  if (arguments.motion.empty())
    return choose(rigged.animations, arguments.animation, arguments.scene);
  if (!arguments.animation.empty())
    throw Error(ErrorCode::usage, "give a file or the name of an animation, not both", "--motion");
  return read_motion(map_file(arguments.motion), rigged.rig);
}

/// out.png -> out_0007.png
std::string numbered(const std::string& output, int number) {
  if (output.empty()) return {};
  const std::filesystem::path path(output);
  const std::string name =
      fmt::format("{}_{:04}{}", path.stem().string(), number, path.extension().string());
  return (path.parent_path() / name).string();
}

std::vector<Affine> places_of(const Scene& scene) {
  std::vector<Affine> places;
  for (const Instance& instance : scene.instances()) places.push_back(instance.to_world);
  return places;
}

/// A scene loaded in that pose, with nothing shared but vertices and the file's own memory.
std::shared_ptr<const Scene> loaded_in_pose(const Scene& pose, const std::vector<Affine>& places) {
  SceneData data = pose.data();
  for (std::size_t i = 0; i < places.size(); ++i) data.instances[i].to_world = places[i];
  return std::make_shared<const Scene>(std::move(data));
}

class Animation {
 public:
  Animation(const RenderArguments& arguments, Session& session, RiggedScene rigged)
      : arguments_(arguments), session_(session), format_(output_format(arguments)) {
    Motion motion = find_motion(arguments, rigged);
    rest_ = std::make_shared<const Scene>(std::move(rigged.scene));
    poser_.emplace(std::move(rigged.rig), std::move(motion), places_of(*rest_));
    shaper_.emplace(*poser_, std::move(rigged.deformers));
    options_ = make_options(arguments, *rest_, format_);
    spec_ = arguments.spec;
    // What each follows without being built anew.
    if (spec_.empty()) spec_ = shaper_->moving() > 0 ? "bvh" : "two_level";
    accelerator_ = session.build(rest_, spec_);
    build_seconds_ = accelerator_->report().seconds;
  }

  Frame render_frame(int number) {
    session_.context().check(double(number) / arguments_.frames, "frames");
    Frame frame;
    const int intervals = std::max(arguments_.frames - 1, 1);
    frame.time = poser_->duration() * number / intervals;
    const Timer timer;
    const std::vector<Affine> places = poser_->at(frame.time);
    const auto pose = std::make_shared<const Scene>(pose_at(frame.time, places));
    frame.pose_seconds = timer.seconds();
    move_to(pose);
    frame.update_seconds = accelerator_->report().seconds;
    draw(frame, number);
    if (arguments_.verify) verify(frame, number, *pose, places);
    return frame;
  }

  const Poser& poser() const { return *poser_; }
  const Shaper& shaper() const { return *shaper_; }
  const Scene& scene() const { return *rest_; }
  std::string spec() const { return accelerator_->spec(); }
  double build_seconds() const { return build_seconds_; }

 private:
  Scene pose_at(double seconds, const std::vector<Affine>& places) const {
    const Scene posed = rest_->posed(places);
    return shaper_->moving() > 0 ? deformed(posed, shaper_->at(seconds)) : posed;
  }

  /// Structures that cannot move are built anew.
  void move_to(const std::shared_ptr<const Scene>& pose) {
    if (can_move_) {
      try {
        return accelerator_->update(pose, session_.context());
      } catch (const Error& error) {
        if (error.code() != ErrorCode::unsupported) throw;
        can_move_ = false;
      }
    }
    accelerator_ = session_.build(pose, spec_);
  }

  void draw(Frame& frame, int number) {
    const Timer timer;
    const RenderResult result = render(*accelerator_, options_, session_.context());
    frame.trace_seconds = timer.seconds();
    frame.rays = result.rays;
    frame.output = numbered(arguments_.output, number);
    write_image(frame.output, format_, result.image);
  }

  void verify(Frame& frame, int number, const Scene& pose, const std::vector<Affine>& places) {
    const auto loaded = loaded_in_pose(pose, places);
    WorkloadOptions options{options_.view, kCheckedRays, arguments_.seed + unsigned(number)};
    frame.check = check_pose(*accelerator_, loaded, "bvh", options, session_.context());
    const int step = (arguments_.frames + kBruteFrames - 1) / kBruteFrames;
    if (!frame.check->difference.empty() || number % step != 0) return;
    options.rays = kBruteRays;
    const PoseCheck brute =
        check_pose(*accelerator_, loaded, "brute_force", options, session_.context());
    frame.brute_rays = brute.rays;
    frame.check->difference = brute.difference;
  }

  const RenderArguments& arguments_;
  Session& session_;
  Format format_;
  std::shared_ptr<const Scene> rest_;
  std::optional<Poser> poser_;
  std::optional<Shaper> shaper_;
  RenderOptions options_;
  std::string spec_;
  std::unique_ptr<Accelerator> accelerator_;
  double build_seconds_ = 0.0;
  bool can_move_ = true;
};

Json to_json(const Frame& frame) {
  Json json = {{"time", frame.time},
               {"pose_seconds", frame.pose_seconds},
               {"update_seconds", frame.update_seconds},
               {"trace_seconds", frame.trace_seconds},
               {"rays", frame.rays},
               {"output", frame.output.empty() ? Json(nullptr) : Json(frame.output)}};
  if (frame.check) {
    json["rebuild_seconds"] = frame.check->rebuild_seconds;
    json["checked_rays"] = frame.check->rays;
    json["checked_hits"] = frame.check->hits;
    json["brute_force_rays"] = frame.brute_rays;
    json["difference"] = frame.check->difference;
  }
  return json;
}

std::vector<double> column(const std::vector<Frame>& frames, double (*value)(const Frame&)) {
  std::vector<double> values;
  values.reserve(frames.size());
  for (const Frame& frame : frames) values.push_back(value(frame));
  return values;
}

/// Medians over the frames; how often faster a frame is than a structure built anew.
Json summary(const std::vector<Frame>& frames) {
  const auto update = column(frames, [](const Frame& f) { return f.update_seconds; });
  const auto both =
      column(frames, [](const Frame& f) { return f.pose_seconds + f.update_seconds; });
  Json json = {
      {"pose_seconds", median(column(frames, [](const Frame& f) { return f.pose_seconds; }))},
      {"update_seconds", median(update)},
      {"trace_seconds", median(column(frames, [](const Frame& f) { return f.trace_seconds; }))}};
  if (!frames.front().check) return json;
  const auto rebuild = column(frames, [](const Frame& f) { return f.check->rebuild_seconds; });
  std::size_t differing = 0, checked = 0, brute = 0, brute_frames = 0;
  for (const Frame& frame : frames) {
    differing += !frame.check->difference.empty();
    checked += frame.check->rays;
    brute += frame.brute_rays, brute_frames += frame.brute_rays > 0;
  }
  json["rebuild_seconds"] = median(rebuild);
  json["rebuild_over_update"] = median_ratio(rebuild, update).value;
  json["rebuild_over_pose_and_update"] = median_ratio(rebuild, both).value;
  json["checked_rays"] = checked;
  json["brute_force_rays"] = brute;
  json["brute_force_frames"] = brute_frames;
  json["differing_frames"] = differing;
  return json;
}

Json report(const RenderArguments& arguments, const Animation& animation,
            const std::vector<Frame>& frames) {
  Json rows = Json::array();
  for (const Frame& frame : frames) rows.push_back(to_json(frame));
  return {{"scene", arguments.scene},
          {"structure", animation.spec()},
          {"instances", animation.scene().instances().size()},
          {"moving_instances", animation.poser().moving()},
          {"deformed_geometries", animation.shaper().moving()},
          {"instanced_primitives", animation.scene().counts().references},
          {"duration", animation.poser().duration()},
          {"build_seconds", animation.build_seconds()},
          {"frames", rows},
          {"summary", summary(frames)}};
}

std::string text(const Json& json) {
  const auto ms = [](const Json& seconds) { return 1e3 * seconds.get<double>(); };
  std::string table = fmt::format(
      "{}: {} of {} instances move, {} geometries deform, {} primitives, structure {} built in "
      "{:.3f} ms\n"
      "{:>5} {:>9} {:>10} {:>10} {:>10}",
      json["scene"].get<std::string>(), json["moving_instances"].get<std::size_t>(),
      json["instances"].get<std::size_t>(), json["deformed_geometries"].get<std::size_t>(),
      json["instanced_primitives"].get<std::uint64_t>(), json["structure"].get<std::string>(),
      ms(json["build_seconds"]), "frame", "time s", "pose ms", "update ms", "trace ms");
  const bool is_checked = json["summary"].contains("rebuild_seconds");
  table += is_checked ? fmt::format(" {:>10} {:>6}\n", "rebuild ms", "same") : "\n";
  int number = 0;
  for (const Json& frame : json["frames"]) {
    table += fmt::format("{:>5} {:>9.4f} {:>10.4f} {:>10.4f} {:>10.3f}", number++,
                         frame["time"].get<double>(), ms(frame["pose_seconds"]),
                         ms(frame["update_seconds"]), ms(frame["trace_seconds"]));
    if (is_checked)
      table += fmt::format(" {:>10.3f} {:>6}", ms(frame["rebuild_seconds"]),
                           frame["difference"] == "" ? "yes" : "NO");
    table += '\n';
  }
  const Json& all = json["summary"];
  table +=
      fmt::format("medians: pose {:.4f} ms, update {:.4f} ms, trace {:.3f} ms\n",
                  ms(all["pose_seconds"]), ms(all["update_seconds"]), ms(all["trace_seconds"]));
  if (is_checked)
    table += fmt::format(
        "bvh built anew: {:.3f} ms, {:.0f} times the update, {:.0f} times pose and update\n"
        "same bits as bvh built anew on {} rays, as brute_force on {} rays of {} frames; {} frames "
        "differ\n",
        ms(all["rebuild_seconds"]), all["rebuild_over_update"].get<double>(),
        all["rebuild_over_pose_and_update"].get<double>(), all["checked_rays"].get<std::size_t>(),
        all["brute_force_rays"].get<std::size_t>(), all["brute_force_frames"].get<std::size_t>(),
        all["differing_frames"].get<std::size_t>());
  return table;
}

}  // namespace

int run_frames(const RenderArguments& arguments) {
  output_format(arguments);
  Session session(arguments);
  Animation animation(arguments, session, session.load_rigged(arguments.scene));
  std::vector<Frame> frames;
  frames.reserve(static_cast<std::size_t>(arguments.frames));
  for (int number = 0; number < arguments.frames; ++number)
    frames.push_back(animation.render_frame(number));
  session.finish_progress();
  const Json json = report(arguments, animation, frames);
  arguments.json ? print_json(json) : print_text(text(json));
  const bool differs = json["summary"].value("differing_frames", 0) > 0;
  return differs ? kExitCheckFailed : kExitOk;
}

}  // namespace strahl::cli
