// structures/wide_bvh/wide_estimate.h - how many bytes a wide tree will take, before it is built.
//
// Method: neighbourhoods of the scene, found by median cuts that go on into a random half, are
// built
//   over as the whole will be, and their bytes per primitive taken for those of all. What spatial
//   splits add depends on the scene and is seen there, too. A scene no larger than the sample is
//   built, so its estimate is exact.
// Thread safety: pure functions.
#pragma once

#include <strahl/structures/wide_bvh/wide_bvh.h>

namespace strahl {

/// Bytes that report() of a WideBvh over the source will give, within about a tenth. O(n), and a
/// build over some 16,000 primitives. Deterministic. Throws as a build does.
std::uint64_t estimate_wide_bytes(const PrimitiveSource& source, const WideBvhOptions& options,
                                  const BuildContext& context);

}  // namespace strahl
