#include <algorithm>
#include <apps/strahl/bench_scaling.h>
#include <apps/strahl/text_table.h>
#include <cmath>

#include <fmt/core.h>

#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>
#include <strahl/measure/stopwatch.h>

namespace strahl::cli {
namespace {

using peer::Peer;
using peer::PeerApi;

/// Builds until that has taken a while, each freed before the next.
/// @param make makes one and returns its seconds
template <class Make>
double median_build(Make make, int repeat) {
  constexpr double kEnough = 1.0;
  std::vector<double> seconds;
  double sum = 0.0;
  while (static_cast<int>(seconds.size()) < repeat && sum < kEnough) {
    seconds.push_back(make());
    sum += seconds.back();
  }
  return median(seconds);
}

/// The median of `repeat` runs after one that warms up.
template <class Run>
Json ray_json(const RaySet& set, const char* api, const char* interface, Run run, int repeat) {
  run();
  std::vector<double> seconds(static_cast<std::size_t>(repeat));
  for (double& each : seconds) each = run();
  return {{"workload", name_of(set.kind)},
          {"api", api},
          {"interface", interface},
          {"nanoseconds_per_ray", 1e9 * median(seconds) / static_cast<double>(set.rays.size())}};
}

/// One size; holds one structure at a time.
class Size {
 public:
  Size(const std::string& name, const BenchOptions& options, Session& session)
      : name_(name), options_(options), session_(session), scene_(session.load(name)) {}

  Json own_row(const std::string& spec) {
    Json rays = Json::array(), row;
    for (const OwnApi api : {OwnApi::batch, OwnApi::single}) {
      const std::string used = spec_for(api, spec);
      std::unique_ptr<Accelerator> built;
      const double seconds = median_build([&] { return build_own(used, built); }, options_.repeat);
      if (sets_.empty())
        sets_ = make_ray_sets(*built, options_.workload_kinds(), rays_of(options_, *scene_),
                              session_.context());
      if (row.empty()) row = head(spec, seconds, static_cast<double>(built->report().bytes));
      for (const RaySet& set : sets_) {
        Contest contest(set);
        rays.push_back(ray_json(
            set, name_of(api), name_of(api), [&] { return contest.run(*built); }, options_.repeat));
      }
    }
    row["rays"] = rays;
    return row;
  }

  Json peer_row() {
    std::unique_ptr<Peer> peer;
    const double seconds = median_build(
        [&] {
          peer.reset();
          peer = peer_over(*scene_, options_, session_);
          return peer->build_seconds();
        },
        options_.repeat);
    Json row = head(options_.peer, seconds, static_cast<double>(peer->bytes()));
    row["rays"] = Json::array();
    for (const RaySet& set : sets_) {
      Contest contest(set);
      for (const OwnApi api : {OwnApi::batch, OwnApi::single}) {
        const PeerApi interface =
            api == OwnApi::single ? PeerApi::single : contest.fastest_api(*peer);
        row["rays"].push_back(ray_json(
            set, name_of(api), name_of(interface), [&] { return contest.run(*peer, interface); },
            options_.repeat));
      }
    }
    return row;
  }

 private:
  double build_own(const std::string& spec, std::unique_ptr<Accelerator>& built) const {
    built.reset();
    const Stopwatch watch(session_.context().executor);
    built = build(scene_, spec, session_.context());
    return watch.seconds();
  }
  Json head(const std::string& engine, double seconds, double bytes) const {
    const double count = std::max(scene_->size(), 1u);
    return {{"scene", name_},
            {"triangles", scene_->size()},
            {"engine", engine},
            {"build_seconds", seconds},
            {"bytes", std::llround(bytes)},
            {"bytes_per_triangle", bytes / count}};
  }

  std::string name_;
  const BenchOptions& options_;
  Session& session_;
  std::shared_ptr<const Scene> scene_;
  std::vector<RaySet> sets_;  ///< the same for all
};

}  // namespace

std::string scaled_scene(const std::string& generator, double triangles) {
  double size = 0.0;
  if (generator == "terrain")
    size = 1.0 + std::round(std::sqrt(triangles / 2.0));
  else if (generator == "soup")
    size = triangles;
  else if (generator == "sticks")
    size = triangles / 24.0;
  else if (generator == "icosphere")
    size = std::log2(triangles / 20.0) / 2.0;
  else
    throw Error(ErrorCode::usage,
                "got '" + generator + "', expected terrain, soup, sticks or icosphere",
                "--generator");
  return fmt::format("gen:{}:{:.0f}", generator, std::max(std::round(size), 1.0));
}

std::vector<double> scaled_sizes(double from, double to, double step) {
  if (!(from >= 1.0 && from <= to))
    throw Error(ErrorCode::usage, "above --to or below 1", "--from");
  if (!(step > 1.0)) throw Error(ErrorCode::usage, "not above 1", "--step");
  std::vector<double> sizes;
  // The last but one is left out where it is about the last.
  for (double size = from; size < 0.999 * to; size *= step) sizes.push_back(size);
  sizes.push_back(to);
  return sizes;
}

Json measure_scaling(const BenchOptions& options, Session& session) {
  Json rows = Json::array();
  const std::vector<double> sizes = scaled_sizes(options.from, options.to, options.step);
  for (const double triangles : sizes) {
    const std::string name = scaled_scene(options.generator, triangles);
    session.note(name);
    Size size(name, options, session);
    for (const std::string& spec : split_specs(options.specs)) rows.push_back(size.own_row(spec));
    if (options.has_peer()) rows.push_back(size.peer_row());
  }
  return rows;
}

std::string scaling_markdown(const Json& rows) {
  std::vector<std::vector<std::string>> table{
      {"triangles", "engine", "build, s", "build, ns per triangle", "bytes per triangle"}};
  if (rows.empty()) return "";
  for (const Json& ray : rows[0]["rays"])
    table[0].push_back(fmt::format("{} {}, ns per ray", ray["workload"].get<std::string>(),
                                   ray["api"].get<std::string>()));
  for (const Json& row : rows) {
    const double seconds = row["build_seconds"].get<double>();
    table.push_back({row["triangles"].dump(), row["engine"].get<std::string>(),
                     fmt::format("{:.4g}", seconds),
                     fmt::format("{:.0f}", 1e9 * seconds / row["triangles"].get<double>()),
                     number_text(row["bytes_per_triangle"], 1)});
    for (const Json& head : rows[0]["rays"])
      for (const Json& ray : row["rays"])
        if (ray["workload"] == head["workload"] && ray["api"] == head["api"])
          table.back().push_back(number_text(ray["nanoseconds_per_ray"], 1));
  }
  return text_table(table);
}

}  // namespace strahl::cli
