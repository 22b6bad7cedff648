// traverse/nasty_rays_test.h - grids of cells and rays that make trouble in them, for tests.
#pragma once

#include <cmath>
#include <vector>

#include <strahl/base/rng.h>
#include <strahl/math/ray.h>
#include <strahl/math/uniform_cells.h>

namespace strahl {

/// Rays that make trouble in a grid of cells.
class NastyRays {
 public:
  NastyRays(const UniformCells& cells, std::uint64_t seed) : cells_(cells), rng_(seed) {}

  PreparedRay next() {
    Ray ray{point(), {}};
    const Vec3d target = point();
    ray.dir = rng_.below(3) == 0 ? small_direction() : target - ray.org;
    for (int a = 0; a < 3; ++a)
      if (rng_.below(6) == 0) ray.dir[a] = 0.0;
    if (norm_max(ray.dir) == 0.0) ray.dir.y = -1.0;
    if (rng_.below(3) == 0) {
      const double distances[] = {1.0, 30.0, 1e6, 1e12, 1e15, 1e18, 1e30};
      ray.org = target - distances[rng_.below(7)] / norm_max(ray.dir) * ray.dir;
    }
    if (rng_.below(4) == 0) ray.t_min = rng_.uniform(), ray.t_max = ray.t_min + rng_.uniform();
    RayFrame frame;
    frame.bounds = {{}, {}};
    if (rng_.below(3) == 0) frame.widen_absolute = std::pow(10.0, rng_.uniform(-16, 0));
    if (rng_.below(3) == 0) frame.widen_per_org = 1e-15;
    return PreparedRay(ray, frame);
  }

 private:
  Vec3d small_direction() {
    const auto whole = [&] { return static_cast<double>(rng_.below(5)) - 2; };
    const double x = whole(), y = whole();
    return {x, y, whole()};
  }
  /// A corner of a cell, a point in a plane between cells, or any point in or near the grid.
  Vec3d point() {
    Vec3d p;
    const bool is_corner = rng_.below(2) == 0;
    for (int a = 0; a < 3; ++a) {
      const double lo = cells_.plane(a, 0), hi = cells_.plane(a, cells_.n(a));
      const auto plane = static_cast<int>(rng_.below(static_cast<std::uint32_t>(cells_.n(a)) + 1));
      p[a] = is_corner || rng_.below(3) == 0 ? cells_.plane(a, plane)
                                             : lo + rng_.uniform(-0.3, 1.3) * (hi - lo);
    }
    return p;
  }

  const UniformCells& cells_;
  Rng rng_;
};

inline std::vector<UniformCells> grids() {
  return {UniformCells({{0, 0, 0}, {8, 8, 8}}, {8, 8, 8}),
          UniformCells({{-1, 2, 1000.1}, {1, 2.1, 1000.7}}, {7, 13, 3}),
          UniformCells({{0, 0, 5}, {1, 3, 5}}, {6, 11, 1}),
          UniformCells({{1e5, 1e5, 1e5}, {1e5 + 1, 1e5 + 0.7, 1e5 + 0.3}}, {9, 5, 4}),
          UniformCells({{-3, -3, -3}, {3, 3, 3}}, {1, 1, 1})};
}

}  // namespace strahl
