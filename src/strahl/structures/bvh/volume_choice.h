// structures/bvh/volume_choice.h - which kind of volume each node of a hierarchy gets: the cheapest
// assignment there is in the cost model of bounding volumes.
//
// Paper:      [Weghorst1984]: T = n B + m I, n rays tested at B each, m let through at I each.
// Model:      n and m are the areas of the parent's and of the own volume, as for random lines. A
//             hierarchy costs the sum of area(volume of the parent) B(kind) over its nodes, and of
//             area(volume) * primitives * I over its leaves; rays come to the root by the area of
//             its box.
// Method:     dynamic programming over (node, kind), exact in the model: f(v, k) is the cost below
//             v when it has kind k; each child takes the kind that is cheapest under k, as its own
//             tests are paid by v's area. O(nodes * kinds^2).
// Caveat:     a volume that sticks out of its parent's is met less often than its area says.
// Thread safety: pure functions.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <strahl/bounds/bounding_volume.h>
#include <strahl/structures/bvh/volume_fit.h>

namespace strahl {

inline constexpr std::size_t kVolumeKinds = kBoundingVolumes.size();
/// Of one node's volume, per kind; infinite where the kind is not to be had.
using VolumeAreas = std::array<double, kVolumeKinds>;

/// In any unit of time.
struct VolumeCosts {
  /// One test per kind and of a triangle, in nanoseconds: medians over ten parts, as printed last
  /// by `bounds_bench ../shared/scenes` and listed in bounds/README.md.
  std::array<double, kVolumeKinds> test{5.5,  10.3, 27.1, 5.3,  11.6, 14.5,
                                        20.9, 26.7, 21.7, 51.3, 70.3, 16.2};
  double primitive = 9.5;
};

struct VolumeChoice {
  std::vector<BoundingVolumeKind> kinds;  ///< per node
  double cost = 0.0;                      ///< expected per ray that meets the box of the root
};

/// @param areas per node of the hierarchy, which must not be empty
VolumeChoice choose_volumes(const Hierarchy& hierarchy, std::span<const VolumeAreas> areas,
                            const VolumeCosts& costs);

/// Half areas of all kinds around the nodes. Throws Error{cancelled}.
std::vector<VolumeAreas> measure_volumes(const NodeContents& contents, const BuildContext& context);

}  // namespace strahl
