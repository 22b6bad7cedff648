// measure/workloads.h - standard sets of rays through a scene: made once, then the same for every
// structure and program that is measured.
//
// Rays are values of float32 (but for `whitted`), so that programs of single precision get exactly
// the same ones. Secondary rays start a little above the surface they leave instead of excluding
// it, since not every program can exclude.
// The ray tree of `whitted` follows the rules of the standard scenes [Haines1987].
// Thread safety: pure functions besides the accelerator's batches.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <strahl/catalog/accelerator.h>

namespace strahl {

/// primary: through the pixels of the view, in tiles of 8 x 8; shadow: from visible points to a
/// lamp; ao: short, around visible points; diffuse: bounced once off visible points; random:
/// between points of the bounding sphere; whitted: the whole ray tree of a picture, with
/// reflections, refractions and shadows.
enum class WorkloadKind { primary, shadow, ao, diffuse, random, whitted };

inline constexpr WorkloadKind kAllWorkloads[] = {WorkloadKind::primary, WorkloadKind::shadow,
                                                 WorkloadKind::ao,      WorkloadKind::diffuse,
                                                 WorkloadKind::random,  WorkloadKind::whitted};

const char* name_of(WorkloadKind kind);
/// Throws Error{usage} naming the known ones.
WorkloadKind workload_kind(std::string_view name);

/// Rays to be asked for their first hit, and rays to be asked whether they hit anything.
struct Workload {
  WorkloadKind kind = WorkloadKind::primary;
  std::vector<Ray> closest, any;
  std::size_t from_eye = 0;  ///< so many of closest, the first of them, leave the eye

  std::size_t size() const { return closest.size() + any.size(); }
};

struct WorkloadOptions {
  View view;  ///< from where `primary` looks and what the others' points are seen from
  std::size_t rays = 100'000;  ///< about as many; `whitted`: primary rays
  std::uint64_t seed = 1;
};

/// Number of rays that `options` ask for at most, except of `whitted`. Fewer when nothing is seen.
/// Throws Error: usage for an impossible view, cancelled.
Workload make_workload(WorkloadKind kind, const Accelerator& accelerator,
                       const WorkloadOptions& options, const BuildContext& context = {});

}  // namespace strahl
