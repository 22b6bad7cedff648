// bounds/fit.h - what fitting volumes share: a cloud in units of its size, and directions to try.
//
// Fitting only chooses axes and centres; extents are then computed from the original coordinates.
// So nothing here has to be conservative.
// Thread safety: pure functions.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <strahl/bounds/enclosed_set.h>

namespace strahl {

/// How much a fit may cost: `fast` for the many nodes of a hierarchy, `thorough` where it pays.
enum class FitEffort { fast, thorough };

/// Two unit vectors that span the plane across an axis, and the axis: right-handed.
struct Basis {
  Vec3d u, v, w;
  explicit Basis(const Vec3d& axis);
};

/// The extreme points of a set, moved to the middle of its box and scaled to about size 1.
struct FitCloud {
  Vec3d center;        ///< of the set's box
  double scale = 1.0;  ///< a power of two: original = center + scale * own
  std::vector<Vec3d> points;
  std::vector<Ball> balls;
  std::vector<std::array<std::uint32_t, 3>> faces;  ///< hull triangles of `points`; may be empty

  /// @param with_faces the hull is made even where there are few points
  explicit FitCloud(const EnclosedSet& set, bool with_faces = false);
  Vec3d to_original(const Vec3d& p) const { return center + scale * p; }
  Vec3d to_own(const Vec3d& p) const { return (p - center) / scale; }
  /// Points, and 14 points on each ball.
  std::vector<Vec3d> surface_points() const;
  /// Smallest and largest n.x.
  std::pair<double, double> extent(const Vec3d& n) const;
};

/// Eigenvectors of a symmetric matrix given by its rows, unit, by descending eigenvalue.
std::array<Vec3d, 3> eigenvectors(std::array<Vec3d, 3> rows);

/// Principal axes of points.
std::array<Vec3d, 3> principal_axes(std::span<const Vec3d> points);

/// Principal axes of the surface of a hull ([Gottschalk1996]); of the points where it has no area.
std::array<Vec3d, 3> principal_axes(std::span<const Vec3d> points,
                                    std::span<const std::array<std::uint32_t, 3>> faces);

/// The 13 directions of a 26-DOP, unit.
const std::array<Vec3d, 13>& dop_directions();

/// From one far point to another, unit; the x axis where all coincide.
Vec3d longest_direction(std::span<const Vec3d> points);

/// Axes worth trying for volumes around an axis.
std::vector<Vec3d> axis_candidates(const FitCloud& cloud, FitEffort effort);

/// An axis and what it costs.
struct AxisChoice {
  Vec3d axis;
  double cost;
};

/// The best of the candidates, refined where the effort is thorough. cost(axis) -> double.
template <class Cost>
AxisChoice best_axis(std::span<const Vec3d> candidates, FitEffort effort, Cost&& cost) {
  AxisChoice best{{1, 0, 0}, Aabb::kInf};
  const auto offer = [&](const Vec3d& axis) {
    const double c = cost(axis);
    if (!(c < best.cost)) return false;
    best = {axis, c};
    return true;
  };
  for (const Vec3d& axis : candidates) offer(axis);
  if (effort == FitEffort::fast) return best;
  // Compass search on the sphere of axes.
  for (double step = 0.1; step > 1e-4; step *= 0.5) {
    for (int tries = 0; tries < 8; ++tries) {
      const Basis basis(best.axis);
      bool is_better = false;
      for (const Vec3d& side : {basis.u, -basis.u, basis.v, -basis.v})
        is_better = is_better || offer(unit(basis.w + step * side));
      if (!is_better) break;
    }
  }
  return best;
}

}  // namespace strahl
