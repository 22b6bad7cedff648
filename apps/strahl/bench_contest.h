// apps/strahl/bench_contest.h - sets of rays, and the time that either side takes for one.
//
// Rays are traced on one thread and timed by processor time, which other programs hardly touch.
#pragma once

#include <apps/strahl/peer/peer.h>
#include <span>
#include <string>
#include <vector>

#include <strahl/catalog/accelerator.h>
#include <strahl/measure/statistics.h>
#include <strahl/measure/workloads.h>

namespace strahl::cli {

/// Rays of one kind as records of float32, asked for their first hit or for any.
struct RaySet {
  WorkloadKind kind = WorkloadKind::primary;
  bool is_any = false;
  std::vector<peer::FloatRay> rays;
};

/// One set for each kind that has rays. Throws Error: usage for `whitted`, which asks for both
/// kinds of hits; cancelled.
std::vector<RaySet> make_ray_sets(const Accelerator& accelerator,
                                  std::span<const WorkloadKind> kinds,
                                  const WorkloadOptions& options, const BuildContext& context);

/// The rays of one set, answered by one competitor after the other.
class Contest {
 public:
  explicit Contest(const RaySet& set);

  /// Seconds.
  double run(const Accelerator& accelerator);
  double run(const peer::Peer& peer, peer::PeerApi api);
  /// The interface whose best of three runs is the shortest.
  peer::PeerApi fastest_api(const peer::Peer& peer);
  /// Rays to which the last run of each side gave different answers; of hits only whether.
  std::size_t differences() const;
  /// Million rays per second, by the median of these times.
  double mrays(const std::vector<double>& seconds) const;

 private:
  const RaySet& set_;
  RayBatch batch_;
  std::vector<Hit> hits_;
  std::vector<peer::PeerHit> peer_hits_;
  std::vector<std::uint8_t> occluded_, peer_occluded_;
};

}  // namespace strahl::cli
