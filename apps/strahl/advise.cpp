// apps/strahl/advise.cpp - `strahl advise`: which structure suits a scene and a number of rays.
#include <apps/strahl/commands.h>

#include <fmt/core.h>

#include <strahl/catalog/catalog.h>
#include <strahl/measure/advisor.h>
#include <strahl/render/framing.h>

namespace strahl::cli {
namespace {

struct AdviseOptions : CommonOptions {
  std::string scene, workload = "random", structures;
  double rays = 1e6;
  AdviseOptions() { threads = 1; }
};

Json to_json(const Prediction& p) {
  return {{"spec", p.spec},
          {"build_seconds", p.build_seconds},
          {"nanoseconds_per_ray", p.seconds_per_ray * 1e9},
          {"total_seconds", p.total_seconds},
          {"bytes", p.bytes}};
}

Json advice_json(const AdviseOptions& options, const Advice& advice) {
  Json predictions = Json::array();
  for (const Prediction& p : advice.predictions) predictions.push_back(to_json(p));
  return {{"scene", options.scene},
          {"workload", options.workload},
          {"rays", options.rays},
          {"fastest", advice.fastest().spec},
          {"confidence", advice.confidence},
          {"smallest", advice.smallest().spec},
          {"trial_primitives", advice.trial_primitives},
          {"trial_seconds", advice.trial_seconds},
          {"predictions", predictions}};
}

std::string advice_text(const AdviseOptions& options, const Advice& advice) {
  std::string text = fmt::format("{:<28} {:>10} {:>10} {:>10} {:>12}\n", "predicted", "build s",
                                 "ns per ray", "total s", "bytes");
  for (const Prediction& p : advice.predictions)
    text += fmt::format("{:<28} {:>10.4f} {:>10.1f} {:>10.4f} {:>12.0f}\n", p.spec, p.build_seconds,
                        p.seconds_per_ray * 1e9, p.total_seconds, p.bytes);
  return text + fmt::format(
                    "fastest for {:.6g} rays ({}): {}, {:.0f} % sure\nleast memory: {}\n"
                    "tried on {} primitives for {:.2f} s\n",
                    options.rays, options.workload, advice.fastest().spec,
                    100.0 * advice.confidence, advice.smallest().spec, advice.trial_primitives,
                    advice.trial_seconds);
}

int run_advise(const AdviseOptions& options) {
  Session session(options);
  const std::shared_ptr<const Scene> scene = session.load(options.scene);
  AdviceOptions wanted;
  wanted.workload = workload_kind(options.workload);
  wanted.view = default_view(*scene, 512, 512);
  wanted.rays = options.rays;
  if (!options.structures.empty()) wanted.candidates = split_specs(options.structures);
  const Advice advice = advise(scene, wanted, session.context());
  session.finish_progress();
  options.json ? print_json(advice_json(options, advice))
               : print_text(advice_text(options, advice));
  return kExitOk;
}

}  // namespace

void add_advise_command(CLI::App& app, Runner& run) {
  CLI::App* command = app.add_subcommand("advise", "Which structure suits a scene");
  command->footer(
      "Builds the likely structures over the scene, or over every k-th primitive of a large one,\n"
      "asks each some rays and predicts from that the time for building and for all rays. The\n"
      "SPEC 'auto' is this advice, wherever a structure is named.\n"
      "Workloads: primary shadow ao diffuse random whitted.\n"
      "Examples:\n"
      "  strahl advise bunny.ply --workload primary --rays 2000000\n"
      "  strahl advise gen:tree:11 --rays 1e9 --json");
  auto options = std::make_shared<AdviseOptions>();
  command->add_option("scene", options->scene, kSceneHelp)->required()->type_name("SCENE");
  command->add_option("--workload", options->workload, "Kind of rays to come (default: random)")
      ->type_name("NAME");
  command->add_option("--rays", options->rays, "Number of rays to come (default: 1e6)")
      ->check(CLI::Range(0.0, 1e18));
  command->add_option("--structures", options->structures, "SPECs to try (default: the likely)")
      ->type_name("SPEC,...");
  add_common_options(*command, *options);
  command->callback([=, &run] { run = [=] { return run_advise(*options); }; });
}

}  // namespace strahl::cli
