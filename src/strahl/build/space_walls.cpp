#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <strahl/build/coverage.h>
#include <strahl/build/space_naive.h>
#include <strahl/build/space_walls.h>
#include <strahl/geometry/outline.h>

namespace strahl {
namespace {

/// Boxes of triangles are twice as large: what they fill must be at least this part.
constexpr double kEnough = 1.0 - 1e-9;

/// Looks for covered planes across one axis.
class WallFinder {
 public:
  WallFinder(std::span<const Fragment> fragments, const PrimitiveSource& source,
             const PlaneCost& cost, std::size_t axis)
      : fragments_(fragments), source_(source), cost_(cost), axis_(axis) {}

  void offer_best(SplitPlane& best) const {
    const std::vector<const Fragment*> flat = flat_fragments();
    for (auto first = flat.begin(); first != flat.end();) {
      const auto last = std::find_if(first, flat.end(), [&](const Fragment* f) {
        return f->lo[axis_] != (*first)->lo[axis_] || f->hi[axis_] != (*first)->hi[axis_];
      });
      const std::span<const Fragment* const> group(first, last);
      first = last;
      if (!is_covered(group)) continue;
      const SplitPlane plane = plane_beside(group);
      if (plane.cost < best.cost) best = plane;
    }
  }

 private:
  /// Whether there is no room for a plane within: no extent, or a coordinate between two floats.
  bool is_flat(const Fragment& f) const {
    return f.hi[axis_] <= std::nextafter(f.lo[axis_], std::numeric_limits<float>::infinity());
  }

  /// By position, then as they come.
  std::vector<const Fragment*> flat_fragments() const {
    std::vector<const Fragment*> flat;
    for (const Fragment& f : fragments_)
      if (is_flat(f) && cost_.is_inside(axis_, f.lo[axis_]) && cost_.is_inside(axis_, f.hi[axis_]))
        flat.push_back(&f);
    std::stable_sort(flat.begin(), flat.end(), [&](const Fragment* a, const Fragment* b) {
      return std::pair(a->lo[axis_], a->hi[axis_]) < std::pair(b->lo[axis_], b->hi[axis_]);
    });
    return flat;
  }

  bool is_covered(std::span<const Fragment* const> group) const {
    double boxes = 0.0;
    for (const Fragment* f : group) boxes += part_of_section(*f);
    if (!(boxes >= kEnough)) return false;
    OpenArea open;
    for (const Fragment* f : group) {
      const Outline t = source_.outline(f->reference);
      if (t.is_triangle())
        open.cover({on_section(t.ball[0].center), on_section(t.ball[1].center),
                    on_section(t.ball[2].center)});
      if (open.is_covered()) return true;
      if (open.is_scattered()) return false;
    }
    return false;
  }

  /// Share of the cell's cross-section that the fragment's box fills.
  double part_of_section(const Fragment& f) const {
    double part = 1.0;
    for (const std::size_t axis : {(axis_ + 1) % 3, (axis_ + 2) % 3})
      part *= (static_cast<double>(f.hi[axis]) - static_cast<double>(f.lo[axis])) /
              cost_.cell().extent()[static_cast<int>(axis)];
    return part;
  }

  /// Where the cross-section is the unit square.
  PlanarPoint on_section(const Vec3d& p) const {
    const int u = static_cast<int>((axis_ + 1) % 3), v = static_cast<int>((axis_ + 2) % 3);
    const Aabb& cell = cost_.cell();
    const Vec3d extent = cell.extent();
    return {(p[u] - cell.lo[u]) / extent[u], (p[v] - cell.lo[v]) / extent[v]};
  }

  /// The plane that leaves the group to the smaller side.
  SplitPlane plane_beside(std::span<const Fragment* const> group) const {
    const int a = static_cast<int>(axis_);
    const float lo = group.front()->lo[axis_], hi = group.front()->hi[axis_];
    const auto middle = 0.5 * (static_cast<double>(lo) + static_cast<double>(hi));
    const bool is_left = middle - cost_.cell().lo[a] <= cost_.cell().hi[a] - middle;
    const float position = is_left ? hi : lo;
    const PlaneCounts counts = count_about(fragments_, axis_, position);
    SplitPlane plane{axis_, position, is_left, counts.left, counts.right, 0.0};
    (is_left ? plane.left_count : plane.right_count) += counts.planar;
    const std::size_t beyond = plane.left_count + plane.right_count - group.size();
    const double spared = cost_.crossing(axis_) * sah_leaf_cost(cost_.sah(), beyond) / 2;
    plane.cost =
        cost_.of(axis_, static_cast<double>(position), plane.left_count, plane.right_count) -
        spared;
    return plane;
  }

  std::span<const Fragment> fragments_;
  const PrimitiveSource& source_;
  const PlaneCost& cost_;
  std::size_t axis_;
};

}  // namespace

SplitPlane find_covered_plane(std::span<const Fragment> fragments, const PrimitiveSource& source,
                              const PlaneCost& cost) {
  SplitPlane best;
  for (std::size_t axis = 0; axis < 3; ++axis)
    WallFinder(fragments, source, cost, axis).offer_best(best);
  return best;
}

}  // namespace strahl
