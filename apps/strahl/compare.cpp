// apps/strahl/compare.cpp - `strahl compare`: structures beside each other on scenes and workloads.
//
// Each scene's results go to a file of their own in the output folder as soon as they are there; a
// second run with the same options takes them from it, so an interrupted comparison goes on.
#include <algorithm>
#include <apps/strahl/arguments.h>
#include <apps/strahl/commands.h>
#include <apps/strahl/compare_page.h>
#include <apps/strahl/compare_summary.h>
#include <apps/strahl/compare_text.h>
#include <filesystem>
#include <fstream>
#include <optional>

#include <fmt/core.h>

#include <strahl/base/hash.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/atomic_file.h>
#include <strahl/io/png.h>
#include <strahl/measure/statistics.h>
#include <strahl/render/framing.h>
#include <strahl/render/heat_map.h>

namespace strahl::cli {
namespace {

struct CompareOptions : CommonOptions {
  std::vector<std::string> scenes;
  std::string structures = "all", workloads = "primary,shadow,ao,diffuse,random", output;
  std::string maps = "256x192";  ///< or "none"
  std::size_t rays = 0;          ///< of every workload; 0: each its default
  ComparisonOptions comparison;
  CompareOptions() { threads = 1; }
};

/// What --structures names: groups and SPECs. Throws Error{usage}.
std::vector<std::string> specs_of(const std::string& list) {
  static const std::vector<std::string> kClassic{
      "grid",   "recursive_grid", "hug", "adaptive_grid",
      "octree", "kd_tree",        "bih", "bvh:builder=goldsmith_salmon,arity=16"};
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
  return {{"structures", c.specs},
          {"workloads", workloads},
          {"rays", c.rays},
          {"eye_rays", c.eye_rays},
          {"min_rays", c.min_rays},
          {"repeats", c.repeats},
          {"seconds_per_cell", c.seconds_per_cell},
          {"seed", c.seed},
          {"threads", options.threads},
          {"maps", options.maps},
          {"epo", c.with_overlap}};
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

/// Writes the numbers that are known so far.
void write_results(const CompareOptions& options, Json& document) {
  const std::filesystem::path folder(options.output);
  document["summary"] = compare_summary(document["scenes"]);
  write_text_file(folder / "compare.json", document.dump(2) + "\n");
  write_text_file(folder / "compare.csv", compare_csv(document));
  write_text_file(folder / "compare.md", compare_markdown(document));
}

void write_page(const CompareOptions& options, Session& session, const Json& document) {
  const std::filesystem::path folder(options.output);
  const std::vector<Chart> charts = compare_charts(document);
  if (!draw_charts(charts, folder / "charts"))
    session.warn("gnuplot is not installed: the page has no charts");
  write_text_file(folder / "compare.html", compare_page(document, charts, folder));
}

/// The end of a scale for all structures. Those far worse than the rest would leave the others in
/// the dark: they run off it.
double common_scale(const SceneComparison& comparison, std::vector<float> WorkMaps::*map) {
  constexpr double kShown = 0.8;
  std::vector<double> scales;
  for (const ComparisonRow& row : comparison.rows) scales.push_back(heat_scale(row.maps.*map));
  return quantile(scales, kShown);
}

/// Writes the heat maps of a scene and tells the rows of its results where they are.
void write_maps(const CompareOptions& options, const SceneComparison& comparison,
                const std::string& prefix, Json& scene) {
  const ComparisonOptions& c = options.comparison;
  if (c.map_width == 0) return;
  const std::filesystem::path folder(options.output);
  std::filesystem::create_directories(folder / "maps");
  const double steps = common_scale(comparison, &WorkMaps::steps),
               tests = common_scale(comparison, &WorkMaps::tests);
  scene["map_scales"] = {{"steps", steps}, {"tests", tests}, {"difference", tests}};
  const WorkMaps& first = comparison.rows.front().maps;
  for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
    const WorkMaps& maps = comparison.rows[i].maps;
    const auto write = [&](const char* kind, std::vector<float> rgb) {
      const std::string name = fmt::format("maps/{}_{}_{}.png", prefix, i, kind);
      write_png(folder / name, {c.map_width, c.map_height, std::move(rgb), {}, {}});
      scene["structures"][i]["maps"][kind] = name;
    };
    write("steps", heat_map(maps.steps, steps));
    write("tests", heat_map(maps.tests, tests));
    write("difference", difference_map(maps.tests, first.tests, tests));
  }
}

/// What the advisor is told, where "auto" is among the structures.
AdviceOptions rays_of(const ComparisonOptions& options, const View& view) {
  AdviceOptions rays;
  rays.view = view;
  rays.workload = options.workloads.front();
  rays.rays = static_cast<double>(options.rays * options.workloads.size());
  return rays;
}

Json compare_scene(const CompareOptions& options, Session& session, const std::string& name) {
  const std::shared_ptr<const Scene> scene = session.load(name);
  const std::filesystem::path part = part_path(options, *scene);
  if (std::optional<Json> known = earlier(part)) return *known;
  const View view = default_view(*scene, 512, 512);
  ComparisonOptions wanted = options.comparison;
  for (std::string& spec : wanted.specs)
    spec = session.chosen_spec(scene, spec, rays_of(wanted, view));
  const SceneComparison comparison = compare_structures(scene, view, wanted, session.context());
  Json json = to_json(comparison, *scene);
  write_maps(options, comparison, part.stem().string(), json);
  write_text_file(part, json.dump(2) + "\n");
  return json;
}

int run_compare(CompareOptions& options) {
  options.comparison.specs = specs_of(options.structures);
  options.comparison.workloads = workloads_of(options.workloads);
  if (options.maps != "none") {
    const ImageSize size = parse_image_size(options.maps, "--maps");
    options.comparison.map_width = size.width, options.comparison.map_height = size.height;
  }
  if (options.rays > 0) options.comparison.rays = options.comparison.eye_rays = options.rays;
  Session session(options);
  std::filesystem::create_directories(std::filesystem::path(options.output) / "parts");
  Json document = {{"options", options_json(options)}, {"scenes", Json::array()}};
  for (const std::string& name : options.scenes) {
    document["scenes"].push_back(compare_scene(options, session, name));
    write_results(options, document);
  }
  write_page(options, session, document);
  session.finish_progress();
  options.json ? print_json(document) : print_text(compare_markdown(document));
  return kExitOk;
}

}  // namespace

void add_compare_command(CLI::App& app, Runner& run) {
  CLI::App* command =
      app.add_subcommand("compare", "Structures beside each other on the same scenes and rays");
  command->footer(
      "Writes DIR/compare.json, compare.csv, compare.md and compare.html, one file with ranks,\n"
      "charts (by gnuplot) and heat maps. Runs of all structures alternate; every answer is\n"
      "compared bit by bit (exit code 1 if two differ). An interrupted run goes on where it was.\n"
      "Groups of structures: all (but brute_force), classic.\n"
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
  command
      ->add_option("--rays", options->rays,
                   "Rays per workload, rays from the eye of whitted (default: 100000 and 263169)")
      ->check(CLI::Range(1, 100'000'000));
  command->add_option("--min-rays", c.min_rays, "Rays that the slowest structures are asked")
      ->check(CLI::Range(64, 100'000'000));
  command->add_option("--repeat", c.repeats, "Times that everything is measured")
      ->check(CLI::Range(1, 1000));
  command
      ->add_option("--budget", c.seconds_per_cell,
                   "Seconds for one structure on one workload, all repeats and warming up")
      ->check(CLI::Range(0.001, 1e6));
  command->add_option("--maps", options->maps, "Size of heat maps, or none (default: 256x192)")
      ->type_name("WxH");
  command->add_flag("--epo", c.with_overlap,
                    "Also the end-point overlap of trees of volumes, see 'strahl info' (slow)");
  command->add_option("--seed", c.seed, "Of the random numbers in rays");
  command->add_option("-o,--output", options->output, "Folder of results")
      ->required()
      ->type_name("DIR");
  add_common_options(*command, *options);
  command->callback([=, &run] { run = [=] { return run_compare(*options); }; });
}

}  // namespace strahl::cli
