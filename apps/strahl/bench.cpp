// apps/strahl/bench.cpp - `strahl bench`: the production path alone or against a peer.
#include <apps/strahl/bench_builds.h>
#include <apps/strahl/bench_race.h>
#include <apps/strahl/bench_scaling.h>
#include <apps/strahl/bench_worst.h>
#include <apps/strahl/commands.h>
#include <cstdlib>
#include <filesystem>

#include <strahl/catalog/catalog.h>
#include <strahl/io/atomic_file.h>
#include <strahl/structures/wide_bvh/wide_kernel.h>

namespace strahl::cli {
namespace {

/// Scenes of many kinds that need no file: a height field, closed surfaces, parts of machines,
/// repeated solids, and triangles without order.
std::vector<std::string> scenes_of(const BenchOptions& options) {
  if (!options.scenes.empty()) return options.scenes;
  return {"gen:terrain:200", "gen:icosphere:5", "gen:teapot:24",
          "gen:gears:4",     "gen:tetra:8",     "gen:soup:50000"};
}

/// Both sides are held to one instruction set. Throws Error{usage}.
void choose_isa(const BenchOptions& options) {
  if (options.isa.empty()) return;
  ::setenv("STRAHL_ISA", options.isa.c_str(), 1);
  (void)wide_kernel_of_environment();
}

Json options_json(const BenchOptions& options) {
  Json workloads = Json::array();
  for (const WorkloadKind kind : options.workload_kinds()) workloads.push_back(name_of(kind));
  return {{"structures", split_specs(options.specs)},
          {"workloads", workloads},
          {"peer", options.has_peer() ? Json(options.peer) : Json(nullptr)},
          {"isa", wide_kernel_of_environment().isa},
          {"size", options.size},
          {"repeats", options.repeat},
          {"seed", options.seed},
          {"threads", options.threads}};
}

void finish(const BenchOptions& options, Session& session, const Json& document,
            const std::string& text) {
  if (!options.output.empty()) {
    const std::filesystem::path folder(options.output);
    std::filesystem::create_directories(folder);
    write_text_file(folder / "bench.json", document.dump(2) + "\n");
    write_text_file(folder / "bench.md", text);
  }
  session.finish_progress();
  options.json ? print_json(document) : print_text(text);
}

/// Rays of every scene.
std::string bench_rays(const BenchOptions& options, Session& session, Json& document) {
  for (const std::string& name : scenes_of(options)) race_scene(name, options, session, document);
  document["summary"] = race_summary(document["results"]);
  return race_markdown(document);
}

std::string bench_builds(const BenchOptions& options, Session& session, Json& document) {
  document["builds"] = Json::array();
  for (const std::string& name : scenes_of(options)) race_builds(name, options, session, document);
  document["builds_summary"] = builds_summary(document["builds"]);
  return builds_markdown(document);
}

std::string bench_scaling(const BenchOptions& options, Session& session, Json& document) {
  document["scaling"] = measure_scaling(options, session);
  if (!options.output.empty() && !draw_charts(scaling_charts(document["scaling"]),
                                              std::filesystem::path(options.output) / "charts"))
    session.warn("gnuplot is not installed: charts are scripts only");
  return scaling_markdown(document["scaling"]);
}

/// What exactness costs; both parts may be asked for at once.
std::string bench_cost(const BenchOptions& options, Session& session, Json& document) {
  if (options.with_worst) document["worst"] = Json::array();
  if (options.with_doubles) document["doubles"] = Json::array();
  for (const std::string& name : scenes_of(options)) {
    if (options.with_worst) measure_worst(name, options, session, document);
    if (options.with_doubles) measure_doubles(name, options, session, document);
  }
  std::string text;
  if (options.with_worst) text += worst_markdown(document);
  if (options.with_worst && options.with_doubles) text += "\n";
  if (options.with_doubles) text += doubles_markdown(document);
  return text;
}

std::string run_part(const BenchOptions& options, Session& session, Json& document) {
  if (options.with_builds) return bench_builds(options, session, document);
  if (options.with_scaling) return bench_scaling(options, session, document);
  if (options.with_worst || options.with_doubles) return bench_cost(options, session, document);
  return bench_rays(options, session, document);
}

int run_bench(const BenchOptions& options) {
  if (options.has_peer()) peer::require_peer();
  choose_isa(options);
  Session session(options);
  Json document = {{"options", options_json(options)},
                   {"scenes", Json::array()},
                   {"results", Json::array()},
                   {"summary", Json::array()}};
  const std::string text = run_part(options, session, document);
  finish(options, session, document, text);
  return kExitOk;
}

void add_race_options(CLI::App& command, BenchOptions& options) {
  command.add_option("scenes", options.scenes, kSceneHelp)->type_name("SCENE...");
  command.add_option("--peer", options.peer, "Race this one on the same rays: embree")
      ->type_name("NAME")
      ->check(CLI::IsMember({"embree"}));
  command.add_option("--spec,--structures", options.specs, "Own structures (default: wide_bvh)")
      ->type_name("SPEC,...");
  command
      .add_option("--workload,--workloads", options.workloads,
                  "Sets of rays (default: primary,diffuse,shadow,ao,random)")
      ->type_name("NAME,...");
  command
      .add_option("--size", options.size,
                  "Pixels of a side; other sets have as many rays (default: 512)")
      ->check(CLI::Range(1, 8192));
  command.add_option("--repeat", options.repeat, "Times that everything is measured (default: 7)")
      ->check(CLI::Range(1, 1000));
  command.add_option("--isa", options.isa, "Instruction set of both sides: avx512, avx2, sse4")
      ->type_name("NAME");
  command.add_option("--seed", options.seed, "Of the random numbers in rays");
  command.add_option("-o,--output", options.output, "Folder for bench.json, bench.md and charts")
      ->type_name("DIR");
}

void add_part_options(CLI::App& command, BenchOptions& options) {
  CLI::Option* builds =
      command.add_flag("--builds", options.with_builds,
                       "Times of builds and speed of the trees instead: default and quality=fast");
  CLI::Option* scaling =
      command.add_flag("--scaling", options.with_scaling,
                       "Growth with the number of triangles instead; -o also draws charts");
  scaling->excludes(builds)->excludes(command.get_option("scenes"));
  command
      .add_flag("--worst", options.with_worst,
                "Rays through vertices beside rays through insides of triangles instead")
      ->excludes(builds)
      ->excludes(scaling);
  command
      .add_flag("--double", options.with_doubles,
                "Vertices that are no float32 beside such that are instead")
      ->excludes(builds)
      ->excludes(scaling);
  const auto add_size = [&](const char* name, double& value, const char* help) {
    command.add_option(name, value, help)->needs(scaling)->check(CLI::PositiveNumber);
  };
  add_size("--from", options.from, "Least number of triangles (default: 1e4)");
  add_size("--to", options.to, "Greatest number of triangles (default: 3e7)");
  add_size("--step", options.step, "Factor from one size to the next (default: 10)");
  command
      .add_option("--generator", options.generator,
                  "Scene to scale: terrain, soup, sticks or icosphere (default: terrain)")
      ->needs(scaling)
      ->type_name("NAME");
}

}  // namespace

void add_bench_command(CLI::App& app, Runner& run) {
  CLI::App* command =
      app.add_subcommand("bench", "Speed of the production path, also against a peer");
  command->footer(
      "Rays are traced on one thread, exact hits on; --threads (here: 1 unless given) is for "
      "builds.\n"
      "Runs of both sides alternate; a ratio above 1 says that strahl is faster. api=single hands\n"
      "rays over one at a time on both sides, api=batch many at a time, to the peer by its "
      "fastest\n"
      "interface for those rays. Means over scenes are geometric.\n"
      "Without SCENE some generated ones are raced.\n"
      "Workloads: primary diffuse shadow ao random.\n"
      "Examples:\n"
      "  strahl bench\n"
      "  strahl bench bunny.ply gen:terrain:300 --peer embree --json\n"
      "  strahl bench bunny.ply --peer embree --isa avx2 --spec wide_bvh,wide_bvh:quality=high\n"
      "  strahl bench bunny.ply --peer embree --builds --threads 2\n"
      "  strahl bench bunny.ply --worst --double\n"
      "  strahl bench --scaling --peer embree -o results");
  auto options = std::make_shared<BenchOptions>();
  add_race_options(*command, *options);
  add_part_options(*command, *options);
  add_common_options(*command, *options);
  command->callback([=, &run] { run = [=] { return run_bench(*options); }; });
}

}  // namespace strahl::cli
