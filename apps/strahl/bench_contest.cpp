#include <algorithm>
#include <apps/strahl/bench_contest.h>
#include <limits>

#include <strahl/base/error.h>
#include <strahl/measure/stopwatch.h>

namespace strahl::cli {
namespace {

/// At least what the clock can tell apart, so that ratios of very small sets are finite.
double seconds_of(const Stopwatch& watch) { return std::max(watch.seconds(), 1e-6); }

}  // namespace

using peer::FloatRay;
using peer::Peer;
using peer::PeerApi;

std::vector<RaySet> make_ray_sets(const Accelerator& accelerator,
                                  std::span<const WorkloadKind> kinds,
                                  const WorkloadOptions& options, const BuildContext& context) {
  std::vector<RaySet> sets;
  for (const WorkloadKind kind : kinds) {
    if (kind == WorkloadKind::whitted)
      throw Error(ErrorCode::usage, "whitted asks for first and for any hits", "--workloads");
    const Workload workload = make_workload(kind, accelerator, options, context);
    const bool is_any = workload.closest.empty();
    std::vector<FloatRay> rays = peer::float_rays(is_any ? workload.any : workload.closest);
    if (!rays.empty()) sets.push_back({kind, is_any, std::move(rays)});
  }
  return sets;
}

Contest::Contest(const RaySet& set) : set_(set), batch_(peer::batch_of(set.rays)) {
  const std::size_t closest = set.is_any ? 0 : set.rays.size(), any = set.rays.size() - closest;
  hits_.resize(closest), peer_hits_.resize(closest);
  occluded_.resize(any), peer_occluded_.resize(any);
}

double Contest::run(const Accelerator& accelerator) {
  const Stopwatch watch{Executor()};
  if (set_.is_any)
    accelerator.any_hit(batch_, occluded_);
  else
    accelerator.closest_hit(batch_, hits_);
  return seconds_of(watch);
}

double Contest::run(const Peer& peer, PeerApi api) {
  const Stopwatch watch{Executor()};
  if (set_.is_any)
    peer.any(api, set_.rays, peer_occluded_);
  else
    peer.closest(api, set_.rays, peer_hits_);
  return seconds_of(watch);
}

PeerApi Contest::fastest_api(const Peer& peer) {
  double best = std::numeric_limits<double>::infinity();
  PeerApi fastest = PeerApi::single;
  for (const PeerApi api : peer::kPeerApis) {
    double seconds = run(peer, api);
    for (int i = 0; i < 2; ++i) seconds = std::min(seconds, run(peer, api));
    if (seconds < best) best = seconds, fastest = api;
  }
  return fastest;
}

std::size_t Contest::differences() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < hits_.size(); ++i)
    count += hits_[i].is_hit() != peer_hits_[i].is_hit();
  for (std::size_t i = 0; i < occluded_.size(); ++i) count += occluded_[i] != peer_occluded_[i];
  return count;
}

double Contest::mrays(const std::vector<double>& seconds) const {
  return 1e-6 * static_cast<double>(set_.rays.size()) / median(seconds);
}

}  // namespace strahl::cli
