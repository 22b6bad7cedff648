// tests/support/boxes.h - boxes as builders get them, made by hand.
#pragma once

#include <cstdint>
#include <vector>

#include <strahl/build/prim_ref.h>

namespace strahl::test {

/// One reference per box, in order.
inline std::vector<PrimRef> refs_of(const std::vector<Aabb>& boxes) {
  std::vector<PrimRef> refs;
  for (const Aabb& box : boxes) refs.push_back({box, static_cast<std::uint32_t>(refs.size())});
  return refs;
}

inline Aabb cube(const Vec3d& at, double side) { return {at, at + Vec3d::all(side)}; }

}  // namespace strahl::test
