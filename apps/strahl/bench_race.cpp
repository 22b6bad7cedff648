#include <apps/strahl/bench_race.h>
#include <apps/strahl/text_table.h>
#include <map>

#include <strahl/base/hash.h>
#include <strahl/catalog/catalog.h>

namespace strahl::cli {
namespace {

using peer::Peer;
using peer::PeerApi;

/// Times of one entrant and of the peer before it, round by round.
struct Times {
  std::vector<double> own, peer;
};

Json row_of(const RaySet& set, const Contest& contest, const Entrant& entrant, const Times& times,
            PeerApi api) {
  Json row = {{"workload", name_of(set.kind)},
              {"api", name_of(entrant.api)},
              {"spec", entrant.spec},
              {"rays", set.rays.size()},
              {"mrays", contest.mrays(times.own)},
              {"peer_mrays", nullptr},
              {"peer_api", nullptr}};
  std::optional<Estimate> ratio;
  if (!times.peer.empty()) {
    row["peer_mrays"] = contest.mrays(times.peer);
    row["peer_api"] = name_of(api);
    ratio = median_ratio(times.peer, times.own);
  }
  add_estimate(row, "ratio", ratio);
  row["differing_rays"] = ratio ? Json(contest.differences()) : Json(nullptr);
  return row;
}

/// One entrant and the peer in turn; others would push both out of the caches in between.
Times run_rounds(Contest& contest, const Entrant& entrant, const Peer* peer, PeerApi api,
                 int repeat) {
  Times times;
  for (int round = 0; round <= repeat; ++round) {
    const double theirs = peer != nullptr ? contest.run(*peer, api) : 0.0;
    const double own = contest.run(*entrant.accelerator);
    if (round == 0) continue;  // warms up
    times.own.push_back(own);
    if (peer != nullptr) times.peer.push_back(theirs);
  }
  return times;
}

/// All entrants on one set of rays.
void race_set(const std::vector<Entrant>& entrants, const Peer* peer, const RaySet& set, int repeat,
              Json& rows) {
  Contest contest(set);
  const PeerApi best = peer != nullptr ? contest.fastest_api(*peer) : PeerApi::single;
  for (const Entrant& entrant : entrants) {
    const PeerApi api = entrant.api == OwnApi::single ? PeerApi::single : best;
    const Times times = run_rounds(contest, entrant, peer, api, repeat);
    rows.push_back(row_of(set, contest, entrant, times, api));
  }
}

Json build_json(const Entrant& entrant, std::uint32_t primitives) {
  const BuildReport report = entrant.accelerator->report();
  return {{"spec", entrant.spec},
          {"seconds", report.seconds},
          {"bytes", report.bytes},
          {"bytes_per_primitive", static_cast<double>(report.bytes) / std::max(primitives, 1u)}};
}

Json scene_json(const std::string& name, const Scene& scene, const std::vector<Entrant>& entrants,
                const Peer* peer) {
  Json builds = Json::array();
  for (const Entrant& entrant : entrants)
    if (entrant.api == OwnApi::batch) builds.push_back(build_json(entrant, scene.size()));
  if (peer != nullptr)
    builds.push_back(
        {{"spec", "embree"},
         {"seconds", peer->build_seconds()},
         {"bytes", peer->bytes()},
         {"bytes_per_primitive", static_cast<double>(peer->bytes()) / std::max(scene.size(), 1u)}});
  return {{"scene", label_of(name)},
          {"scene_hash", to_hex(scene.hash())},
          {"primitives", scene.size()},
          {"builds", builds}};
}

Json mean_row(const std::string& spec, const Json& api, const std::string& workload,
              const std::vector<const Json*>& rows) {
  Json mean = {{"spec", spec}, {"api", api}, {"workload", workload}, {"rows", rows.size()}};
  add_estimate(mean, "ratio", mean_of(rows, "ratio"));
  return mean;
}

std::string text_of(const Json& json) { return json.is_null() ? "-" : json.get<std::string>(); }

std::string scenes_markdown(const Json& scenes) {
  std::vector<std::vector<std::string>> rows{
      {"scene", "primitives", "built", "seconds", "bytes per primitive"}};
  for (const Json& scene : scenes)
    for (const Json& build : scene["builds"])
      rows.push_back({text_of(scene["scene"]), scene["primitives"].dump(), text_of(build["spec"]),
                      number_text(build["seconds"], 3),
                      number_text(build["bytes_per_primitive"], 1)});
  return text_table(rows);
}

std::string results_markdown(const Json& results) {
  std::vector<std::vector<std::string>> rows{{"scene", "workload", "api", "structure", "M rays/s",
                                              "peer", "its interface", "ratio (95 %)",
                                              "differing rays"}};
  for (const Json& row : results)
    rows.push_back({text_of(row["scene"]), text_of(row["workload"]), text_of(row["api"]),
                    text_of(row["spec"]), number_text(row["mrays"], 2),
                    number_text(row["peer_mrays"], 2), text_of(row["peer_api"]),
                    estimate_text(row, "ratio"), number_text(row["differing_rays"], 0)});
  return text_table(rows);
}

std::string summary_markdown(const Json& summary) {
  std::vector<std::vector<std::string>> rows{{"geometric mean", "api", "workload", "ratio (95 %)"}};
  for (const Json& row : summary)
    if (!row["ratio"].is_null())
      rows.push_back({text_of(row["spec"]), text_of(row["api"]), text_of(row["workload"]),
                      estimate_text(row, "ratio")});
  return text_table(rows);
}

}  // namespace

std::vector<Entrant> build_entrants(const std::shared_ptr<const Scene>& scene,
                                    const std::vector<std::string>& specs, Session& session) {
  std::vector<Entrant> entrants;
  for (const std::string& spec : specs) {
    std::map<std::string, std::shared_ptr<const Accelerator>> built;
    for (const OwnApi api : kOwnApis) {
      std::shared_ptr<const Accelerator>& accelerator = built[spec_for(api, spec)];
      if (!accelerator) accelerator = session.build(scene, spec_for(api, spec));
      entrants.push_back({spec, api, accelerator});
    }
  }
  return entrants;
}

Json race(const std::vector<Entrant>& entrants, const Peer* peer, const std::vector<RaySet>& sets,
          int repeat, const BuildContext& context) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < sets.size(); ++i) {
    context.check(static_cast<double>(i) / static_cast<double>(sets.size()), "racing");
    race_set(entrants, peer, sets[i], repeat, rows);
  }
  return rows;
}

void race_scene(const std::string& name, const BenchOptions& options, Session& session,
                Json& document) {
  const std::shared_ptr<const Scene> scene = session.load(name);
  const std::unique_ptr<Peer> peer = peer_over(*scene, options, session);
  const std::vector<Entrant> entrants = build_entrants(scene, split_specs(options.specs), session);
  document["scenes"].push_back(scene_json(name, *scene, entrants, peer.get()));
  const std::vector<RaySet> sets =
      make_ray_sets(*entrants.front().accelerator, options.workload_kinds(),
                    rays_of(options, *scene), session.context());
  for (const Json& row : race(entrants, peer.get(), sets, options.repeat, session.context())) {
    Json result = {{"scene", label_of(name)}, {"primitives", scene->size()}};
    result.update(row);
    document["results"].push_back(result);
  }
}

Json race_summary(const Json& results) {
  std::map<std::pair<std::string, std::string>, std::map<std::string, std::vector<const Json*>>>
      groups;
  for (const Json& row : results) {
    auto& workloads = groups[{row["spec"], row["api"]}];
    workloads[row["workload"]].push_back(&row);
    workloads["all"].push_back(&row);
  }
  Json summary = Json::array();
  for (const auto& [group, workloads] : groups)
    for (const auto& [workload, rows] : workloads)
      summary.push_back(mean_row(group.first, group.second, workload, rows));
  return summary;
}

std::string race_markdown(const Json& document) {
  return scenes_markdown(document["scenes"]) + "\n" + results_markdown(document["results"]) + "\n" +
         summary_markdown(document["summary"]);
}

}  // namespace strahl::cli
