// tests/conformance/rays.h - adversarial rays for a scene, with filters to go with them.
#pragma once

#include <vector>

#include <strahl/query/ray_batch.h>

namespace strahl::test {

/// Rays and, per ray, the filters of a batch.
struct RaySet {
  std::vector<Ray> rays;
  std::vector<std::uint32_t> masks;
  std::vector<PrimitiveId> excluded;
  std::vector<Cursor> after;
  std::vector<std::uint8_t> cull;

  /// The rays alone, or with all filters. Refers to this object.
  RayBatch batch(bool filtered) const;
};

/// About `count` rays: through vertices, edges and along them, in planes of faces, from surfaces,
/// axis-parallel through vertices, zero-length and empty intervals, invalid, random, from afar.
/// Filters exclude or resume after what the ray meets at `hits` of an oracle, so they bind.
RaySet adversarial_rays(const Scene& scene, std::size_t count, std::uint64_t seed);

/// Makes the filters bind: cursors at and exclusions of the given first hits.
void bind_filters(RaySet& set, std::span<const Hit> first_hits, std::uint64_t seed);

}  // namespace strahl::test
