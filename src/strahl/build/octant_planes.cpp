#include <algorithm>
#include <vector>

#include <strahl/build/octant_planes.h>

namespace strahl {
namespace {

/// Places where Octree-R looks, the middle and the median included.
constexpr int kCandidates = 10;

double median_center(std::span<const PrimRef> refs, const Aabb& cell, int axis) {
  std::vector<double> centers(refs.size());
  std::transform(refs.begin(), refs.end(), centers.begin(), [&](const PrimRef& ref) {
    return Aabb::intersection(ref.box, cell).center()[axis];
  });
  const auto median = centers.begin() + static_cast<std::ptrdiff_t>(centers.size() / 2);
  std::nth_element(centers.begin(), median, centers.end());
  return *median;
}

/// What [Havran1999] prints: the face parallel to the plane is counted once, the others twice.
double cost_of(std::span<const PrimRef> refs, const Aabb& cell, int axis, double plane) {
  std::size_t below = 0, above = 0;
  for (const PrimRef& ref : refs) {
    below += ref.box.lo[axis] <= plane;
    above += ref.box.hi[axis] >= plane;
  }
  const Vec3d size = cell.extent();
  const double b = size[(axis + 1) % 3], c = size[(axis + 2) % 3];
  const auto area = [b, c](double t) { return 2.0 * t * (b + c) + b * c; };
  return static_cast<double>(below) * area(plane - cell.lo[axis]) +
         static_cast<double>(above) * area(cell.hi[axis] - plane);
}

double cheapest_plane(std::span<const PrimRef> refs, const Aabb& cell, int axis, double middle) {
  if (refs.empty()) return middle;
  const double median = median_center(refs, cell, axis);
  double best = middle, least = cost_of(refs, cell, axis, middle);
  for (int i = 1; i < kCandidates; ++i) {
    const double plane = middle + (median - middle) * i / (kCandidates - 1);
    if (!(cell.lo[axis] < plane && plane < cell.hi[axis])) break;
    const double cost = cost_of(refs, cell, axis, plane);
    if (cost < least) best = plane, least = cost;
  }
  return best;
}

}  // namespace

OctantPlanes find_octant_planes(std::span<const PrimRef> refs, const Aabb& cell,
                                const OctantOptions& options, const OctantAxes& axes) {
  OctantPlanes planes;
  const double rim = options.place == OctantPlace::inner ? 0.5 * (options.looseness - 1.0) : 0.0;
  for (int k = 0; k < axes.count; ++k) {
    const int axis = axes[k];
    double plane = 0.5 * cell.lo[axis] + 0.5 * cell.hi[axis];
    if (!(cell.lo[axis] < plane && plane < cell.hi[axis])) continue;
    if (options.split == OctantSplit::octree_r) plane = cheapest_plane(refs, cell, axis, plane);
    planes.middle[axis] = plane;
    planes.end[axis] = plane + rim * (plane - cell.lo[axis]);
    planes.begin[axis] = plane - rim * (cell.hi[axis] - plane);
    planes.low[axis] = cell.lo[axis] - rim * (plane - cell.lo[axis]);
    planes.high[axis] = cell.hi[axis] + rim * (cell.hi[axis] - plane);
    planes.is_found = true;
  }
  return planes;
}

}  // namespace strahl
