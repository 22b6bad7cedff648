// tests/support/bundles.h - boxes that reach far into each other: bounds by area hardly tell them
// apart, so a search that cuts a little too much loses its way.
#pragma once

#include <tests/support/boxes.h>
#include <vector>

#include <strahl/base/rng.h>

namespace strahl::test {

/// Bundles of boxes of nearly one size.
inline std::vector<PrimRef> bundled_refs(std::uint32_t count, std::uint32_t bundles,
                                         std::uint64_t seed) {
  Rng rng(seed);
  const auto at = [&](double reach) {
    return Vec3d{rng.uniform(0, reach), rng.uniform(0, reach), rng.uniform(0, reach)};
  };
  std::vector<Vec3d> corners;
  for (std::uint32_t i = 0; i < bundles; ++i) corners.push_back(at(0.8));
  std::vector<Aabb> boxes;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3d lo = corners[rng.below(bundles)] + at(0.05);
    boxes.push_back({lo, lo + Vec3d::all(0.6) + at(0.05)});
  }
  return refs_of(boxes);
}

}  // namespace strahl::test
