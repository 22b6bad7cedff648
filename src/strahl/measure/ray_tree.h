// measure/ray_tree.h - every ray that a picture of the standard scenes asks for [Haines1987].
//
// An eye ray has depth 1. A hit on something that reflects or transmits sends a reflected ray, one
// on something that transmits also a refracted ray unless there is total reflection, down to depth
// 5. Every hit sends one shadow ray to each lamp above its surface (of what
// transmits: its outer side). No ray is left out because it
// would matter little.
// Thread safety: pure function besides the accelerator's batches.
#pragma once

#include <vector>

#include <strahl/measure/workloads.h>

namespace strahl {

/// Level by level, each in the order of the level before. O(rays).
Workload make_ray_tree(const Accelerator& accelerator, std::vector<Ray> eye_rays,
                       const BuildContext& context);

}  // namespace strahl
