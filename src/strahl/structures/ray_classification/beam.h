// structures/ray_classification/beam.h - everything the rays of a cell can reach, and conservative
// tests of what lies in it.
//
// Source: [ArvoKirk1987]; sides of lines as in Pluecker coordinates ([Shoemake1998]).
// Geometry: the beam is the box of the cell's origins plus the cone of its directions w, one
//   component of which is +-1. A half-space n.x <= c holds it if n.w <= 0 for the four corner
//   directions and c = max n.o over the box.
// Slack: a ray of the cell that hits a thing has a parallel within kRaySlack that starts in the
//   box; stored outlines are off by 2^-24. So a thing is out only if it is by kBeamSlack: the rest
//   of it is many times what the roundings here add up to, 2^-45.
// Triangles: w.((a - o) x (b - a)) is the side on which the ray (o, w) passes edge ab, linear in o
//   and in w, so its extremes over the cell are at corners. A ray hits if the sides of all edges
//   agree (docs/semantics.md); if two edges differ for all rays of the cell, none hits.
// Fronts: a front hit has dir.N <= 0. Normals of stored corners are off by the slack of the
// corners,
//   and seen through an instance by 2^-20 of an angle (3 roundings times a condition below 2^30).
// Thread safety: const methods are safe from any number of threads.
#pragma once

#include <span>

#include <strahl/structures/ray_classification/ray_cell.h>

namespace strahl {

/// A ball as stored with candidates.
struct StoredBall {
  float x, y, z, radius;
  Vec3d center() const { return {x, y, z}; }
};

/// The reach of a cell's rays.
class Beam {
 public:
  Beam(const RayCell& cell, int face);

  /// About how wide the beam is in the middle of the scene, in local units.
  double breadth() const { return breadth_; }
  /// Whether a ray of the cell may meet the box, in local units.
  bool may_meet(const Vec3d& lo, const Vec3d& hi) const;
  /// Whether one may meet the hull of these balls.
  bool may_meet_hull(std::span<const StoredBall> balls) const;
  /// Whether one may meet the triangle with these corners.
  bool may_meet_triangle(std::span<const StoredBall> corners) const;
  /// False if every hit with the triangle is one of its back.
  bool may_see_front(std::span<const StoredBall> corners) const;

 private:
  /// Holds the beam: normal.x <= limit, the slack included.
  struct HalfSpace {
    Vec3d normal;
    double limit = 0.0, length = 0.0;
  };
  static constexpr std::size_t kMostSides = 9;

  bool holds_all(const Vec3d& normal) const;
  double limit_of(const Vec3d& normal) const;
  void add_side(const Vec3d& normal);
  int side_of_edge(const Vec3d& a, const Vec3d& b) const;

  std::array<HalfSpace, kMostSides> sides_;
  std::size_t side_count_ = 0;
  std::array<Vec3d, 4> corner_;  ///< directions
  Vec3d center_, half_;          ///< of the origins
  double breadth_ = 0.0;
};

}  // namespace strahl
