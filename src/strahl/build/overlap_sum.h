// build/overlap_sum.h - the sum behind an end-point overlap, over the primitives of a scene.
//
// Thread safety: pure functions.
#pragma once

#include <cstdint>

#include <strahl/base/build_context.h>
#include <strahl/base/function_ref.h>
#include <strahl/geometry/scene.h>

namespace strahl {

struct OverlapAreas {
  double surface = 0.0, overlap = 0.0;  ///< of the primitives; weighted by what visits cost
};

/// Overlap over surface, 0 without a surface. The same for any executor.
/// @param areas of primitives [begin, end); called from several threads
/// Throws Error{cancelled}.
double overlap_share(const Scene& scene, const BuildContext& context,
                     function_ref<OverlapAreas(std::uint32_t begin, std::uint32_t end)> areas);

}  // namespace strahl
