// measure/comparison.h - structures on the same scene and rays, interleaved, with equal answers.
//
// Fairness: every structure gets the same rays in the same run; runs of all structures alternate,
// in another order each round, so that a machine that slows down slows all of them. Each round
// builds everything anew and goes through all workloads: where a structure comes to lie in memory
// and what else the machine does then differ within a comparison as they do between two, and
// intervals over rounds tell of both. A structure too slow for its time gets fewer rays, in blocks
// spread evenly over the set, so that coherence and mixture stay. Every answer is compared bit by
// bit with that of the first structure.
// Thread safety: one comparison at a time per process, or times mean nothing.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <strahl/measure/workloads.h>

namespace strahl {

struct ComparisonOptions {
  std::vector<std::string> specs;
  std::vector<WorkloadKind> workloads;
  std::size_t rays = 100'000;  ///< per workload
  std::size_t eye_rays =
      std::size_t{513} * 513;     ///< of `whitted`, which adds the rest of the tree; as published
  std::size_t min_rays = 10'000;  ///< that every structure is asked, however slow it is
  int repeats = 6;                ///< the fewest of which 95 % intervals exist
  double seconds_per_cell = 2.0;  ///< for one structure on one workload, all repeats and warming up
  std::uint64_t seed = 1;
  int map_width = 0, map_height = 0;  ///< of heat maps from the view; 0: none
  bool with_overlap = false;          ///< also Accelerator::end_point_overlap(), which is slow
};

/// Work of the rays through the pixels' centres, row by row from the top; empty without maps.
struct WorkMaps {
  std::vector<float> steps, tests;
};

/// One structure on one workload.
struct ComparisonCell {
  WorkloadKind workload = WorkloadKind::primary;
  std::size_t rays = 0;         ///< per repeat
  std::vector<double> seconds;  ///< of each repeat, by Stopwatch
  Counters counters;            ///< of `rays` rays
};

/// One structure.
struct ComparisonRow {
  std::string spec;
  BuildReport build;                  ///< after all rays; seconds: the median
  std::vector<double> build_seconds;  ///< of each repeat, by Stopwatch
  std::optional<double> overlap;      ///< end-point overlap, where asked for and there is one
  std::vector<ComparisonCell> cells;  ///< in the order of the workloads
  WorkMaps maps;
};

/// What a workload is like, by the answers to it.
struct WorkloadSummary {
  WorkloadKind kind = WorkloadKind::primary;
  std::size_t closest_rays = 0, closest_hits = 0, any_rays = 0, any_hits = 0;
  std::size_t eye_rays = 0, eye_hits = 0;  ///< of the closest, those that leave the eye
};

struct SceneComparison {
  std::vector<WorkloadSummary> workloads;
  std::vector<ComparisonRow> rows;  ///< in the order of the SPECs
};

/// Builds all structures, traces all workloads from the scene's view and compares.
/// Throws Error: usage for a bad SPEC or no SPEC, resource, cancelled; std::logic_error naming
/// SPEC, workload and ray when two structures answer differently.
SceneComparison compare_structures(const std::shared_ptr<const Scene>& scene, const View& view,
                                   const ComparisonOptions& options,
                                   const BuildContext& context = {});

/// At least `count` of the rays, or all, in as few blocks of 64 as hold them, which lie evenly
/// spread over all.
std::vector<std::size_t> spread_blocks(std::size_t rays, std::size_t count);

}  // namespace strahl
