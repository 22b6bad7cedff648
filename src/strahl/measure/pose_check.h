// measure/pose_check.h - a structure that has followed its scene against one built anew.
//
// Thread safety: one check at a time, or times mean nothing.
#pragma once

#include <memory>
#include <string>

#include <strahl/measure/workloads.h>

namespace strahl {

struct PoseCheck {
  std::size_t rays = 0;          ///< asked of both
  std::size_t hits = 0;          ///< of all of them, every crossing counted
  double rebuild_seconds = 0.0;  ///< of the structure built anew
  std::string difference;        ///< empty when all hits have the same bits
};

/// Builds `spec` over a scene loaded in the pose that `moved` has been moved to, and asks both for
/// the first and for all hits of half primary rays, half rays at random through the scene.
/// Throws Error: as a build and as make_workload().
PoseCheck check_pose(const Accelerator& moved, const std::shared_ptr<const Scene>& loaded,
                     const std::string& spec, const WorkloadOptions& options,
                     const BuildContext& context = {});

}  // namespace strahl
