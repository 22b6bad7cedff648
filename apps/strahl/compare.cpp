// apps/strahl/compare.cpp - `strahl compare`: structures beside each other on scenes and workloads.
//
// Each scene's results go to a file of their own in the output folder as soon as they are there; a
// second run with the same options takes them from it, so an interrupted comparison goes on.
#include <apps/strahl/commands.h>
#include <apps/strahl/compare_text.h>
#include <filesystem>
#include <fstream>
#include <optional>

#include <fmt/core.h>

#include <strahl/base/hash.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/atomic_file.h>
#include <strahl/render/framing.h>

namespace strahl::cli {
namespace {

struct CompareOptions : CommonOptions {
  std::vector<std::string> scenes;
  std::string structures = "all", workloads = "primary,shadow,ao,diffuse,random", output;
  ComparisonOptions comparison;
  CompareOptions() { threads = 1; }
};

/// What --structures names: groups and SPECs. Throws Error{usage}.
std::vector<std::string> specs_of(const std::string& list) {
  static const std::vector<std::string> kClassic{"grid",   "recursive_grid", "hug", "adaptive_grid",
                                                 "octree", "kd_tree",        "bih", "bvh"};
  std::vector<std::string> specs;
  for (const std::string& item : split_specs(list)) {
    if (item == "classic") {
      specs.insert(specs.end(), kClassic.begin(), kClassic.end());
    } else if (item == "all") {
      for (const StructureEntry& entry : all_structures())
        if (entry.name != std::string_view("brute_force")) specs.emplace_back(entry.name);
    } else {
      specs.push_back(item);
    }
  }
  return specs;
}

std::vector<WorkloadKind> workloads_of(const std::string& list) {
  std::vector<WorkloadKind> kinds;
  for (const std::string& name : split_specs(list)) kinds.push_back(workload_kind(name));
  if (kinds.empty()) throw Error(ErrorCode::usage, "no workload", "--workloads");
  return kinds;
}

Json options_json(const CompareOptions& options) {
  const ComparisonOptions& c = options.comparison;
  Json workloads = Json::array();
  for (const WorkloadKind kind : c.workloads) workloads.push_back(name_of(kind));
  return {{"structures", c.specs}, {"workloads", workloads},
          {"rays", c.rays},        {"min_rays", c.min_rays},
          {"repeats", c.repeats},  {"seconds_per_cell", c.seconds_per_cell},
          {"seed", c.seed},        {"threads", options.threads}};
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

/// The file of a scene's results: named by everything they depend on but the machine.
std::filesystem::path part_path(const CompareOptions& options, const Scene& scene) {
  const std::string key = options_json(options).dump();
  Hash64 hash;
  hash.add(scene.hash());
  hash.add(std::span<const char>(key.data(), key.size()));
  return std::filesystem::path(options.output) / "parts" / (to_hex(hash.digest()) + ".json");
}

/// What an earlier run has left there; nothing when it is not readable.
std::optional<Json> earlier(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return std::nullopt;
  Json json = Json::parse(file, nullptr, false);
  if (json.is_discarded() || !json.contains("structures")) return std::nullopt;
  return json;
}

void write_results(const CompareOptions& options, const Json& document) {
  const std::filesystem::path folder(options.output);
  write_text(folder / "compare.json", document.dump(2) + "\n");
  write_text(folder / "compare.csv", compare_csv(document));
  write_text(folder / "compare.md", compare_markdown(document));
}

Json compare_scene(const CompareOptions& options, Session& session, const std::string& name) {
  const std::shared_ptr<const Scene> scene = session.load(name);
  const std::filesystem::path part = part_path(options, *scene);
  if (std::optional<Json> known = earlier(part)) return *known;
  const SceneComparison comparison = compare_structures(scene, default_view(*scene, 512, 512),
                                                        options.comparison, session.context());
  Json json = to_json(comparison, *scene);
  write_text(part, json.dump(2) + "\n");
  return json;
}

int run_compare(CompareOptions& options) {
  options.comparison.specs = specs_of(options.structures);
  options.comparison.workloads = workloads_of(options.workloads);
  Session session(options);
  std::filesystem::create_directories(std::filesystem::path(options.output) / "parts");
  Json document = {{"options", options_json(options)}, {"scenes", Json::array()}};
  for (const std::string& name : options.scenes) {
    document["scenes"].push_back(compare_scene(options, session, name));
    write_results(options, document);
  }
  session.finish_progress();
  options.json ? print_json(document) : print_text(compare_markdown(document));
  return kExitOk;
}

}  // namespace

void add_compare_command(CLI::App& app, Runner& run) {
  CLI::App* command =
      app.add_subcommand("compare", "Structures beside each other on the same scenes and rays");
  command->footer(
      "Writes DIR/compare.json, compare.csv and compare.md. Runs of all structures alternate; "
      "every\n"
      "answer is compared bit by bit (exit code 1 if two differ). An interrupted run goes on "
      "where\n"
      "it was. Groups of structures: all (but brute_force), classic.\n"
      "Workloads: primary shadow ao diffuse random whitted.\n"
      "Examples:\n"
      "  strahl compare gen:balls:4 bunny.ply --structures bvh,kd_tree,grid -o results\n"
      "  strahl compare gen:tree:11 --structures classic --workloads whitted -o results");
  auto options = std::make_shared<CompareOptions>();
  command->add_option("scenes", options->scenes, kSceneHelp)->required()->type_name("SCENE...");
  command
      ->add_option("--structures", options->structures,
                   "SPECs and groups, the first is what times are relative to (default: all)")
      ->type_name("SPEC,...");
  command->add_option("--workloads", options->workloads, "Sets of rays (default: all but whitted)")
      ->type_name("NAME,...");
  ComparisonOptions& c = options->comparison;
  command->add_option("--rays", c.rays, "Rays per workload; whitted: primary rays")
      ->check(CLI::Range(1, 100'000'000));
  command->add_option("--min-rays", c.min_rays, "Rays that the slowest structures are asked")
      ->check(CLI::Range(64, 100'000'000));
  command->add_option("--repeat", c.repeats, "Times that everything is measured")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--budget", c.seconds_per_cell,
                   "Seconds for all repeats of one structure on one workload")
      ->check(CLI::Range(0.001, 1e6));
  command->add_option("--seed", c.seed, "Of the random numbers in rays");
  command->add_option("-o,--output", options->output, "Folder of results")
      ->required()
      ->type_name("DIR");
  add_common_options(*command, *options);
  command->callback([=, &run] { run = [=] { return run_compare(*options); }; });
}

}  // namespace strahl::cli
