// measure/advisor.h - which structure answers a number of rays soonest, found out by a trial.
//
// Each candidate is built over the scene and asked rays of the kind that is to come, in blocks out
// of a larger set, with warm caches. A large scene is thinned for a first trial, in which those
// drop out whose build alone would take longer than others take for everything. A very large one is
// thinned for the second trial, too: the growth of build time, time per ray and memory between both
// is continued up to the whole scene as a power of the number of primitives. Nothing is fitted
// beforehand but the list of candidates, within what such powers are, and how wrong a continuation
// is on average, so that advice holds for the machine it is given on. A trial takes about a second.
// Thread safety: one trial at a time per process, or times mean nothing.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <strahl/measure/workloads.h>

namespace strahl {

/// The SPECs of which one was soonest wherever all structures were compared (docs/findings.md).
const std::vector<std::string>& advisor_candidates();

struct AdviceOptions {
  View view;                                     ///< for the workloads that look from somewhere
  WorkloadKind workload = WorkloadKind::random;  ///< of the rays to come
  double rays = 1e6;                             ///< number of rays to come
  /// Rays like those to come; null: some of the workload are made.
  const Workload* sample = nullptr;
  std::vector<std::string> candidates = advisor_candidates();
  std::uint64_t seed = 1;
};

/// What one candidate is expected to take.
struct Prediction {
  std::string spec;
  double build_seconds = 0.0, seconds_per_ray = 0.0, bytes = 0.0;
  double total_seconds = 0.0;  ///< build and all rays
};

struct Advice {
  std::vector<Prediction> predictions;  ///< soonest first
  double confidence = 0.0;              ///< chance that the first is the soonest of them
  double deviation = 0.0;               ///< standard, expected of ln(predicted / real)
  std::uint32_t trial_primitives = 0;   ///< of the largest scene tried
  double trial_seconds = 0.0;           ///< that the trial took

  const Prediction& fastest() const { return predictions.front(); }
  /// Least memory; of equals the soonest.
  const Prediction& smallest() const;
};

/// Throws Error: usage for no candidate, a bad SPEC or fewer than 0 rays; resource, cancelled.
Advice advise(const std::shared_ptr<const Scene>& scene, const AdviceOptions& options,
              const BuildContext& context = {});

/// What the same trial advises for another number of rays of that kind.
Advice for_rays(Advice advice, double rays);

}  // namespace strahl
