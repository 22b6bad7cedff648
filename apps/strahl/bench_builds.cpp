#include <apps/strahl/bench_builds.h>
#include <apps/strahl/bench_race.h>
#include <apps/strahl/text_table.h>

#include <strahl/catalog/catalog.h>
#include <strahl/measure/stopwatch.h>

namespace strahl::cli {
namespace {

using peer::Peer;
using peer::PeerQuality;

struct Pairing {
  const char* spec;
  PeerQuality quality;
  const char* quality_name;
};
constexpr Pairing kPairings[] = {{"wide_bvh", PeerQuality::high, "HIGH"},
                                 {"wide_bvh:quality=fast", PeerQuality::medium, "MEDIUM"}};

constexpr const char* kRatios[] = {"time_ratio", "single_ratio", "batch_ratio"};

struct BuildTimes {
  std::vector<double> own, peer;  ///< seconds
};

/// Builds of both sides in turn, freed at once. The first round warms up and does not count.
BuildTimes build_in_turn(const std::shared_ptr<const Scene>& scene, const Pairing& pairing,
                         const BenchOptions& options, const Session& session) {
  BuildTimes times;
  for (int round = 0; round <= options.repeat; ++round) {
    const std::unique_ptr<Peer> peer = peer_over(*scene, options, session, pairing.quality);
    const double theirs = peer ? peer->build_seconds() : 0.0;
    const Stopwatch watch(session.context().executor);
    const auto built = build(scene, pairing.spec, session.context());
    const double own = watch.seconds();
    if (round == 0) continue;
    times.own.push_back(own);
    if (peer) times.peer.push_back(theirs);
  }
  return times;
}

/// Adds how fast one tree of each side is traced, as the mean over the sets of rays.
void add_trace(Json& row, const std::shared_ptr<const Scene>& scene, const Pairing& pairing,
               const BenchOptions& options, Session& session) {
  const std::unique_ptr<Peer> peer = peer_over(*scene, options, session, pairing.quality);
  const std::vector<Entrant> entrants = build_entrants(scene, {pairing.spec}, session);
  const std::vector<RaySet> sets =
      make_ray_sets(*entrants.front().accelerator, options.workload_kinds(),
                    rays_of(options, *scene), session.context());
  const Json rows = race(entrants, peer.get(), sets, options.repeat, session.context());
  for (const OwnApi api : kOwnApis) {
    std::vector<const Json*> of_api;
    for (const Json& r : rows)
      if (r["api"] == name_of(api)) of_api.push_back(&r);
    add_estimate(row, std::string(name_of(api)) + "_ratio", mean_of(of_api, "ratio"));
  }
  const double count = std::max(scene->size(), 1u);
  row["bytes_per_primitive"] =
      static_cast<double>(entrants.back().accelerator->report().bytes) / count;
  row["peer_bytes_per_primitive"] =
      peer ? Json(static_cast<double>(peer->bytes()) / count) : Json();
}

Json row_of(const std::shared_ptr<const Scene>& scene, const std::string& name,
            const Pairing& pairing, const BenchOptions& options, Session& session) {
  const BuildTimes times = build_in_turn(scene, pairing, options, session);
  Json row = {{"scene", label_of(name)},
              {"primitives", scene->size()},
              {"spec", pairing.spec},
              {"peer_quality", times.peer.empty() ? Json() : Json(pairing.quality_name)},
              {"seconds", median(times.own)},
              {"peer_seconds", times.peer.empty() ? Json() : Json(median(times.peer))}};
  add_estimate(
      row, "time_ratio",
      times.peer.empty() ? std::optional<Estimate>() : median_ratio(times.own, times.peer));
  add_trace(row, scene, pairing, options, session);
  return row;
}

std::vector<std::string> cells_of(const Json& row) {
  return {row["scene"].get<std::string>(),
          row["primitives"].dump(),
          row["spec"].get<std::string>(),
          number_text(row["seconds"], 4),
          row["peer_quality"].is_null() ? "-" : row["peer_quality"].get<std::string>(),
          number_text(row["peer_seconds"], 4),
          estimate_text(row, "time_ratio"),
          estimate_text(row, "single_ratio"),
          estimate_text(row, "batch_ratio"),
          number_text(row["bytes_per_primitive"], 1),
          number_text(row["peer_bytes_per_primitive"], 1)};
}

std::vector<std::string> mean_cells_of(const Json& row) {
  return {"geometric mean",
          "",
          row["spec"].get<std::string>(),
          "",
          "",
          "",
          estimate_text(row, "time_ratio"),
          estimate_text(row, "single_ratio"),
          estimate_text(row, "batch_ratio"),
          "",
          ""};
}

}  // namespace

void race_builds(const std::string& name, const BenchOptions& options, Session& session,
                 Json& document) {
  const std::shared_ptr<const Scene> scene = session.load(name);
  for (const Pairing& pairing : kPairings)
    document["builds"].push_back(row_of(scene, name, pairing, options, session));
}

Json builds_summary(const Json& builds) {
  Json summary = Json::array();
  for (const Pairing& pairing : kPairings) {
    std::vector<const Json*> rows;
    for (const Json& row : builds)
      if (row["spec"] == pairing.spec) rows.push_back(&row);
    Json mean = {{"spec", pairing.spec}, {"rows", rows.size()}};
    for (const char* ratio : kRatios) add_estimate(mean, ratio, mean_of(rows, ratio));
    summary.push_back(mean);
  }
  return summary;
}

std::string builds_markdown(const Json& document) {
  std::vector<std::vector<std::string>> rows{
      {"scene", "primitives", "structure", "build, s", "peer", "its build, s", "time over its",
       "speed over its: single", "batch", "bytes per primitive", "its"}};
  for (const Json& row : document["builds"]) rows.push_back(cells_of(row));
  for (const Json& row : document["builds_summary"]) rows.push_back(mean_cells_of(row));
  return text_table(rows);
}

}  // namespace strahl::cli
