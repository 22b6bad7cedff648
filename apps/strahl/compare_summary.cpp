#include <algorithm>
#include <apps/strahl/compare_summary.h>
#include <vector>

#include <fmt/core.h>

#include <strahl/measure/ranking.h>

namespace strahl::cli {
namespace {

/// Time per ray of one workload, shape (scenes, structures), and relative to the first structure.
struct Times {
  std::vector<std::vector<double>> per_ray, to_first;
};

Times times_of(const Json& scenes, std::size_t workload) {
  Times times;
  for (const Json& scene : scenes) {
    std::vector<double> per_ray, to_first;
    for (const Json& row : scene["structures"]) {
      const Json& cell = row["workloads"][workload];
      per_ray.push_back(1.0 / std::max(cell["mrays"].get<double>(), 1e-9));
      to_first.push_back(cell["time_to_first"][0].get<double>());
    }
    times.per_ray.push_back(per_ray), times.to_first.push_back(to_first);
  }
  return times;
}

/// Over scenes: how much slower than the best of each at worst, and how often it is the best.
Json against_best(const Times& times, std::size_t structure) {
  double worst = 0.0;
  int wins = 0;
  for (const std::vector<double>& scene : times.per_ray) {
    const double best = *std::min_element(scene.begin(), scene.end());
    worst = std::max(worst, scene[structure] / best);
    wins += scene[structure] == best;
  }
  return {{"worst_to_best", worst}, {"wins", wins}};
}

Json structure_json(const Times& times, std::size_t i, const Json& spec, double mean_rank) {
  std::vector<double> ratios;
  for (const std::vector<double>& scene : times.to_first) ratios.push_back(scene[i]);
  const Estimate mean = geometric_mean(ratios);
  Json json = {{"spec", spec},
               {"mean_rank", mean_rank},
               {"time_to_first", {mean.value, mean.low, mean.high}}};
  json.update(against_best(times, i));
  return json;
}

Json workload_json(const Json& scenes, std::size_t w) {
  const Json& rows = scenes[0]["structures"];
  const Times times = times_of(scenes, w);
  Json structures = Json::array();
  Json json = {{"workload", rows[0]["workloads"][w]["workload"]}, {"scenes", scenes.size()}};
  // One structure has no rank to test.
  const bool ranks = rows.size() > 1;
  const Ranking ranking = ranks ? rank_by_cost(times.per_ray) : Ranking{1, {1.0}, 0.0, 1.0, 0.0};
  json["friedman"] = {{"chi_square", ranking.chi_square}, {"p_value", ranking.p_value}};
  json["critical_difference"] = ranking.critical_difference;
  for (std::size_t i = 0; i < rows.size(); ++i)
    structures.push_back(structure_json(times, i, rows[i]["spec"], ranking.mean_ranks[i]));
  std::stable_sort(structures.begin(), structures.end(), [](const Json& a, const Json& b) {
    return a["mean_rank"].get<double>() < b["mean_rank"].get<double>();
  });
  json["structures"] = structures;
  return json;
}

}  // namespace

Json compare_summary(const Json& scenes) {
  Json workloads = Json::array();
  if (!scenes.empty())
    for (std::size_t w = 0; w < scenes[0]["workloads"].size(); ++w)
      workloads.push_back(workload_json(scenes, w));
  return {{"workloads", workloads}};
}

std::string summary_markdown(const Json& summary) {
  std::string text;
  for (const Json& w : summary["workloads"]) {
    text += fmt::format(
        "## Ranks: {}\n\nOver {} scenes; all alike: p = {:.2g} (Friedman); mean ranks differ "
        "where they are {:.2f} apart (Nemenyi, 5 %).\n\n"
        "| structure | mean rank | time | worst to best | wins |\n|---|---|---|---|---|\n",
        w["workload"].get<std::string>(), w["scenes"].dump(),
        w["friedman"]["p_value"].get<double>(), w["critical_difference"].get<double>());
    for (const Json& s : w["structures"])
      text += fmt::format("| `{}` | {:.2f} | {:.3g} ({:.3g} to {:.3g}) | {:.3g} | {} |\n",
                          s["spec"].get<std::string>(), s["mean_rank"].get<double>(),
                          s["time_to_first"][0].get<double>(), s["time_to_first"][1].get<double>(),
                          s["time_to_first"][2].get<double>(), s["worst_to_best"].get<double>(),
                          s["wins"].get<int>());
    text += "\n";
  }
  return text;
}

}  // namespace strahl::cli
