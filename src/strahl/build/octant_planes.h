// build/octant_planes.h - where a cell of an octree is divided along each axis.
//
// Source: the middle [Glassner1984]; Octree-R [Whang1995] with the candidates and the cost of
//   [Havran1999]: ten places from the middle of the cell to the median of the primitives, axes
//   independent of each other; a half costs the primitives in it, cut ones included, times an
//   area.
// Thread safety: pure functions.
#pragma once

#include <span>

#include <strahl/build/octants.h>

namespace strahl {

/// Planes of a cell; infinite on axes that are not divided.
struct OctantPlanes {
  Vec3d middle = Vec3d::all(Aabb::kInf);  ///< where the cell itself is divided
  Vec3d begin = middle, end = middle;     ///< inner sides of the halves above and below
  Vec3d low = -middle, high = middle;     ///< outer sides of the halves below and above
  bool is_found = false;                  ///< on at least one axis
};

/// O(n) per axis.
OctantPlanes find_octant_planes(std::span<const PrimRef> refs, const Aabb& cell,
                                const OctantOptions& options, const OctantAxes& axes);

}  // namespace strahl
