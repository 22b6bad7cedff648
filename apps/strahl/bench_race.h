// apps/strahl/bench_race.h - own structures and the peer, asked the same rays in turn.
//
// Fairness: neighbouring runs of both sides are compared, so that a machine that slows down slows
// both, and nothing else runs between them; the peer's rays are written as it likes them, and where
// rays are handed over many at a time its fastest interface for the rays at hand counts.
#pragma once

#include <apps/strahl/bench_setup.h>

namespace strahl::cli {

/// A structure and how rays are handed over to it.
struct Entrant {
  std::string spec;  ///< as the user wrote it
  OwnApi api;
  std::shared_ptr<const Accelerator> accelerator;
};

/// Both ways for each SPEC; structures that know one way only are built once.
std::vector<Entrant> build_entrants(const std::shared_ptr<const Scene>& scene,
                                    const std::vector<std::string>& specs, Session& session);

/// One row of results per set of rays and entrant, see docs/json/bench.schema.json; null for what
/// takes a peer where there is none. The first round warms up and does not count.
Json race(const std::vector<Entrant>& entrants, const peer::Peer* peer,
          const std::vector<RaySet>& sets, int repeat, const BuildContext& context);

/// Per SPEC and way of handing over the mean ratio of each workload and of all.
Json race_summary(const Json& results);

/// Loads, builds and races one scene; adds to "scenes" and "results" of the document.
void race_scene(const std::string& name, const BenchOptions& options, Session& session,
                Json& document);

/// "scenes", "results" and "summary" as tables.
std::string race_markdown(const Json& document);

}  // namespace strahl::cli
