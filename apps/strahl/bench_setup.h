// apps/strahl/bench_setup.h - what all parts of `strahl bench` share: options, competitors, output.
#pragma once

#include <apps/strahl/bench_contest.h>
#include <apps/strahl/session.h>
#include <memory>
#include <string>
#include <vector>

namespace strahl::cli {

struct BenchOptions : CommonOptions {
  std::vector<std::string> scenes;
  std::string specs = "wide_bvh", workloads, peer, isa, output;
  int size = 512;  ///< pixels of a side; other sets have as many rays
  int repeat = 7;  ///< of which there are 95 % intervals
  std::uint64_t seed = 1;
  bool with_builds = false, with_scaling = false, with_worst = false, with_doubles = false;
  double from = 1e4, to = 3e7, step = 10.0;  ///< triangles of the scaling
  std::string generator = "terrain";

  BenchOptions() { threads = 1; }
  bool has_peer() const { return !peer.empty(); }
  std::vector<WorkloadKind> workload_kinds() const;  ///< throws Error{usage}
};

/// How rays are handed over to the own structure.
enum class OwnApi { single, batch };
inline constexpr OwnApi kOwnApis[] = {OwnApi::single, OwnApi::batch};
const char* name_of(OwnApi api);

/// The SPEC that takes rays so: for wide_bvh one at a time by its option `batch=single`, unless the
/// SPEC says itself; other structures know one way only.
std::string spec_for(OwnApi api, const std::string& spec);

/// The same rays for a scene whatever is measured.
WorkloadOptions rays_of(const BenchOptions& options, const Scene& scene);

/// A peer over the scene; null where none is asked for.
std::unique_ptr<peer::Peer> peer_over(const Scene& scene, const BenchOptions& options,
                                      const Session& session,
                                      peer::PeerQuality quality = peer::PeerQuality::high);

/// The name of a file or the text of a generator.
std::string label_of(const std::string& scene);

/// Adds "<name>", "<name>_low", "<name>_high"; null without an estimate.
void add_estimate(Json& json, const std::string& name, const std::optional<Estimate>& estimate);

/// The geometric mean of the values of rows, of their low and of their high ends: what
/// add_estimate() has added. Rows without count for nothing; nothing if there are only such.
std::optional<Estimate> mean_of(const std::vector<const Json*>& rows, const std::string& name);

/// "1.234", or "-" for null.
std::string number_text(const Json& value, int digits);
/// "1.234 (1.200 to 1.260)", or "-".
std::string estimate_text(const Json& row, const std::string& name);

}  // namespace strahl::cli
