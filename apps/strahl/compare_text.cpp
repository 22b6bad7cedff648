#include <algorithm>
#include <apps/strahl/compare_summary.h>
#include <apps/strahl/compare_text.h>
#include <vector>

#include <fmt/core.h>

#include <strahl/base/hash.h>
#include <strahl/measure/ranking.h>

namespace strahl::cli {
namespace {

Json per_ray(const Counters& counters, std::size_t rays) {
  const auto mean = [&](std::uint64_t sum) {
    return rays > 0 ? static_cast<double>(sum) / static_cast<double>(rays) : 0.0;
  };
  return {{"N_TS", mean(counters.traversal_steps)},
          {"N_ETS", mean(counters.leaves)},
          {"N_EETS", mean(counters.empty_leaves)},
          {"N_IT", mean(counters.primitives)},
          {"N_BIT", mean(counters.bounding_volumes)}};
}

/// What a structure consists of, by the names of docs/glossary.md.
Json statistics(const ComparisonRow& row) {
  const BuildReport& build = row.build;
  return {{"N_IN", build.nodes - std::min(build.leaves, build.nodes)},
          {"N_V", build.leaves},
          {"N_EV", build.empty_leaves},
          {"N_OIV", build.references},
          {"SAH", build.sah_cost},
          {"EPO", to_json(row.overlap)}};
}

/// Million rays per second at a quantile of the seconds.
double mrays(const ComparisonCell& cell, double p) {
  return cell.seconds.empty() ? 0.0
                              : static_cast<double>(cell.rays) * 1e-6 / quantile(cell.seconds, p);
}

/// Time per ray of each repeat.
std::vector<double> per_ray_seconds(const ComparisonCell& cell) {
  std::vector<double> seconds;
  for (const double s : cell.seconds)
    seconds.push_back(s / static_cast<double>(std::max<std::size_t>(cell.rays, 1)));
  return seconds;
}

CostLine cost_line(const ComparisonRow& row, const ComparisonCell& cell) {
  return {row.build.seconds, median(per_ray_seconds(cell))};
}

/// Rays after which the structure has paid against the first; null when it never does.
Json break_even_json(const ComparisonRow& row, const ComparisonRow& first, std::size_t w) {
  const auto rays = break_even(cost_line(row, row.cells[w]), cost_line(first, first.cells[w]));
  return rays ? Json(*rays) : Json(nullptr);
}

/// @param first the same workload on the first structure
Json cell_json(const ComparisonCell& cell, const ComparisonCell& first) {
  const Estimate slowdown = median_ratio(per_ray_seconds(cell), per_ray_seconds(first));
  return {{"workload", name_of(cell.workload)},
          {"rays", cell.rays},
          {"mrays", mrays(cell, 0.5)},
          {"mrays_quartiles", {mrays(cell, 0.75), mrays(cell, 0.25)}},
          {"seconds", cell.seconds},
          {"time_to_first", {slowdown.value, slowdown.low, slowdown.high}},
          {"per_ray", per_ray(cell.counters, cell.rays)}};
}

Json row_json(const ComparisonRow& row, const ComparisonRow& first, std::uint32_t primitives) {
  Json cells = Json::array();
  for (std::size_t w = 0; w < row.cells.size(); ++w) {
    cells.push_back(cell_json(row.cells[w], first.cells[w]));
    cells.back()["break_even"] = break_even_json(row, first, w);
  }
  Json build = to_json(row.build);
  build["bytes_per_primitive"] =
      static_cast<double>(row.build.bytes) / std::max<std::uint32_t>(primitives, 1);
  build["epo"] = to_json(row.overlap);
  build["seconds_of_repeats"] = row.build_seconds;
  return {
      {"spec", row.spec}, {"build", build}, {"statistics", statistics(row)}, {"workloads", cells}};
}

/// "0.123" or, above 100, without decimals; "-" for what there is not.
std::string number(const Json& value) {
  if (value.is_null()) return "-";
  const double v = value.get<double>();
  return v >= 100.0 ? fmt::format("{:.0f}", v) : fmt::format("{:.3g}", v);
}

std::string structure_table(const Json& scene) {
  std::string text =
      "| structure | build s | B/primitive | N_IN | N_V | N_EV | N_OIV | SAH | EPO |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  for (const Json& row : scene["structures"]) {
    text +=
        fmt::format("| `{}` | {} | {} |", row["spec"].get<std::string>(),
                    number(row["build"]["seconds"]), number(row["build"]["bytes_per_primitive"]));
    for (const char* name : {"N_IN", "N_V", "N_EV", "N_OIV", "SAH", "EPO"})
      text += fmt::format(" {} |", number(row["statistics"][name]));
    text += "\n";
  }
  return text + "\n";
}

std::string workload_table(const Json& scene, std::size_t w) {
  const Json& of = scene["workloads"][w];
  std::string text = fmt::format(
      "{}: {} rays for their first hit ({} hit), {} for any ({} hit); {} of them from the eye ({} "
      "hit).\n\n| structure | rays | Mrays/s | quartiles | time | break-even | N_TS | N_ETS | "
      "N_EETS | N_IT | N_BIT |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
      of["workload"].get<std::string>(), of["closest_rays"].dump(), of["closest_hits"].dump(),
      of["any_rays"].dump(), of["any_hits"].dump(), of["eye_rays"].dump(), of["eye_hits"].dump());
  for (const Json& row : scene["structures"]) {
    const Json &cell = row["workloads"][w], &time = cell["time_to_first"];
    text +=
        fmt::format("| `{}` | {} | {} | {} to {} | {} ({} to {}) | {} |",
                    row["spec"].get<std::string>(), cell["rays"].dump(), number(cell["mrays"]),
                    number(cell["mrays_quartiles"][1]), number(cell["mrays_quartiles"][0]),
                    number(time[0]), number(time[1]), number(time[2]), number(cell["break_even"]));
    for (const char* name : {"N_TS", "N_ETS", "N_EETS", "N_IT", "N_BIT"})
      text += fmt::format(" {} |", number(cell["per_ray"][name]));
    text += "\n";
  }
  return text + "\n";
}

std::string scene_text(const Json& scene) {
  std::string text = fmt::format("## {}\n\n{} primitives\n\n", scene["scene"].get<std::string>(),
                                 scene["primitives"].dump()) +
                     structure_table(scene);
  for (std::size_t w = 0; w < scene["workloads"].size(); ++w) text += workload_table(scene, w);
  return text;
}

}  // namespace

Json to_json(const SceneComparison& comparison, const Scene& scene) {
  Json workloads = Json::array(), structures = Json::array();
  for (const WorkloadSummary& w : comparison.workloads)
    workloads.push_back({{"workload", name_of(w.kind)},
                         {"closest_rays", w.closest_rays},
                         {"closest_hits", w.closest_hits},
                         {"any_rays", w.any_rays},
                         {"any_hits", w.any_hits},
                         {"eye_rays", w.eye_rays},
                         {"eye_hits", w.eye_hits}});
  for (const ComparisonRow& row : comparison.rows)
    structures.push_back(row_json(row, comparison.rows.front(), scene.size()));
  return {{"scene", scene.data().source},
          {"scene_hash", to_hex(scene.hash())},
          {"primitives", scene.size()},
          {"workloads", workloads},
          {"structures", structures}};
}

std::string compare_csv(const Json& document) {
  std::string text =
      "scene,structure,workload,build_seconds,bytes,N_IN,N_V,N_EV,N_OIV,SAH,EPO,rays,mrays,"
      "time_to_first,time_low,time_high,N_TS,N_ETS,N_EETS,N_IT,N_BIT\n";
  for (const Json& scene : document["scenes"])
    for (const Json& row : scene["structures"])
      for (const Json& cell : row["workloads"]) {
        // A SPEC may hold commas.
        text += fmt::format("\"{}\",\"{}\",{}", scene["scene"].get<std::string>(),
                            row["spec"].get<std::string>(), cell["workload"].get<std::string>());
        text += "," + row["build"]["seconds"].dump() + "," + row["build"]["bytes"].dump();
        for (const char* key : {"N_IN", "N_V", "N_EV", "N_OIV", "SAH", "EPO"}) {
          const Json& value = row["statistics"][key];
          text += "," + (value.is_null() ? "" : value.dump());
        }
        text += "," + cell["rays"].dump() + "," + cell["mrays"].dump();
        for (const Json& value : cell["time_to_first"]) text += "," + value.dump();
        for (const char* key : {"N_TS", "N_ETS", "N_EETS", "N_IT", "N_BIT"})
          text += "," + cell["per_ray"][key].dump();
        text += "\n";
      }
  return text;
}

std::string compare_markdown(const Json& document) {
  const auto first = [&] {
    for (const Json& scene : document["scenes"])
      for (const Json& row : scene["structures"]) return row["spec"].get<std::string>();
    return std::string("the first structure");
  };
  std::string text = fmt::format(
      "# Comparison\n\nTime: of a ray, relative to `{}`, with the 95 % interval over repeats, each "
      "with structures built anew. Break-even: rays after which building and tracing took less "
      "than "
      "with that structure. Per ray: steps N_TS, leaves or cells N_ETS, empty ones N_EETS, "
      "primitive "
      "tests N_IT, box tests N_BIT. Of the structure: inner nodes N_IN, leaves or cells N_V, empty "
      "ones N_EV, references N_OIV; SAH: expected cost of a random line in steps; EPO: end-point "
      "overlap, with --epo.\n\n",
      first());
  text += summary_markdown(document["summary"]);
  for (const Json& scene : document["scenes"]) text += scene_text(scene);
  return text;
}

}  // namespace strahl::cli
