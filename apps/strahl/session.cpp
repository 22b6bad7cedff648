#include <apps/strahl/arguments.h>
#include <apps/strahl/interrupt.h>
#include <apps/strahl/session.h>
#include <cstdio>
#include <thread>
#include <unistd.h>
#include <utility>

#include <fmt/core.h>

#include <strahl/catalog/catalog.h>
#include <strahl/io/load.h>

namespace strahl::cli {
namespace {

Executor make_executor(int threads) {
  if (threads == 0) threads = static_cast<int>(std::thread::hardware_concurrency());
  if (!Executor::threads_available() || threads < 2) return {};
  return Executor::with_threads(threads);
}

bool is_empty(const SceneData& data) {
  for (const Geometry& geometry : data.geometries)
    if (geometry.size() > 0) return false;
  return true;
}

}  // namespace

void add_output_options(CLI::App& command, CommonOptions& options) {
  command.add_flag("--json", options.json, "Print one JSON document instead of text");
  command.add_flag("-q,--quiet", options.quiet, "No progress, no warnings");
}

void add_common_options(CLI::App& command, CommonOptions& options) {
  add_output_options(command, options);
  command.add_option("--threads", options.threads, "Threads to use (default: all cores)")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  command.add_option("--memory", options.memory, "Limit of bytes for builds and results, e.g. 2G")
      ->type_name("BYTES");
}

Session::Session(const CommonOptions& options)
    : quiet_(options.quiet), bar_(!options.quiet && isatty(STDERR_FILENO) == 1) {
  if (!options.memory.empty()) context_.memory_limit = parse_bytes(options.memory, "--memory");
  context_.executor = make_executor(options.threads);
  context_.progress = [this](double fraction, std::string_view stage) {
    bar_.update(fraction, stage);
    return interrupt_signal() == 0;
  };
}

void Session::take(SceneData& data, const std::string& scene) {
  for (const std::string& text : data.warnings) warn(text);
  if (is_empty(data)) warn(scene + ": empty scene");
  for (Geometry& geometry : data.geometries) geometry.mask = 1u << (geometry.geometry_id % 32);
}

SceneData Session::load_data(const std::string& scene) {
  SceneData data = load_scene_data(scene);
  take(data, scene);
  return data;
}

RiggedScene Session::load_rigged(const std::string& scene) {
  RiggedScene rigged = load_rigged_scene(scene);
  take(rigged.scene, scene);
  return rigged;
}

std::shared_ptr<const Scene> Session::load(const std::string& scene) {
  SceneData data = load_data(scene);
  return std::make_shared<const Scene>(std::move(data));
}

std::string Session::chosen_spec(const std::shared_ptr<const Scene>& scene, const std::string& spec,
                                 const AdviceOptions& rays_to_come) {
  if (spec != "auto") return spec;
  const Advice advice = advise(scene, rays_to_come, context_);
  if (!quiet_) {
    bar_.clear();
    fmt::print(stderr, "strahl: auto: {} ({:.0f} % sure)\n", advice.fastest().spec,
               100.0 * advice.confidence);
  }
  return advice.fastest().spec;
}

std::unique_ptr<Accelerator> Session::build(std::shared_ptr<const Scene> scene,
                                            const std::string& spec,
                                            const AdviceOptions& rays_to_come) {
  const std::string chosen = chosen_spec(scene, spec, rays_to_come);
  return strahl::build(std::move(scene), chosen, context_);
}

void Session::warn(const std::string& text) { note("warning: " + text); }

void Session::note(const std::string& text) {
  if (quiet_) return;
  bar_.clear();
  fmt::print(stderr, "strahl: {}\n", text);
}

void print_text(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw Error(ErrorCode::resource, "cannot write", "stdout");
}

void print_json(const Json& json) {
  print_text(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

Json to_json(const Vec3d& v) { return Json::array({v.x, v.y, v.z}); }

Json to_json(const Aabb& box) {
  if (box.is_empty()) return nullptr;
  return {{"min", to_json(box.lo)}, {"max", to_json(box.hi)}};
}

Json to_json(const BuildReport& report) {
  Json json = {{"nodes", report.nodes},
               {"leaves", report.leaves},
               {"empty_leaves", report.empty_leaves},
               {"references", report.references},
               {"depth", report.depth},
               {"bytes", report.bytes},
               {"seconds", report.seconds},
               {"sah_cost", report.sah_cost}};
  if (report.binned_planes > 0) {
    json["binned_planes"] = report.binned_planes;
    json["binning_loss"] = report.binning_loss;
    json["largest_binning_loss"] = report.largest_binning_loss;
  }
  return json;
}

Json to_json(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json to_json(const Counters& counters) {
  return {{"traversal_steps", counters.traversal_steps},
          {"leaves", counters.leaves},
          {"empty_leaves", counters.empty_leaves},
          {"bounding_volumes", counters.bounding_volumes},
          {"primitives", counters.primitives},
          {"most_waiting", counters.most_waiting}};
}

}  // namespace strahl::cli
