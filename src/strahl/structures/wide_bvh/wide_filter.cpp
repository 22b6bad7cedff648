#include <algorithm>
#include <cmath>

#include <strahl/math/float_round.h>
#include <strahl/structures/wide_bvh/wide_filter.h>

namespace strahl {
namespace {

constexpr double kUnit = 0x1p-24;

/// Rounds a corner and says by how much: the rounding itself, and that of to_frame().
Vec3f rounded(const Vec3d& p, const WideFrame& frame, double& error) {
  const Vec3d exact = frame.to_frame(p);
  const Vec3f stored(float_nearest(exact.x), float_nearest(exact.y), float_nearest(exact.z));
  error = std::max(error, length(Vec3d(stored) - exact) + 0x1p-51 * norm1(exact));
  return stored;
}

}  // namespace

LaneCorners lane_corners(const TriangleVertices& triangle, const WideFrame& frame) {
  if (frame.is_identity() && has_float_corners(triangle))
    return {Vec3f(triangle.a), Vec3f(triangle.b), Vec3f(triangle.c), 0.0};
  LaneCorners lane;
  lane.a = rounded(triangle.a, frame, lane.error);
  lane.b = rounded(triangle.b, frame, lane.error);
  lane.c = rounded(triangle.c, frame, lane.error);
  lane.error *= 1.0001;
  return lane;
}

LeafBound leaf_bound(double longest, double error) {
  const double L = 1.0001 * std::sqrt(longest) + 2 * error;
  const double per_distance = kUnit * 18.6 * L;
  const double constant = kUnit * 23.6 * L * L + 10 * error * L + 1e-30;
  // 1.7321 = sqrt 3 turns a largest component into a norm; 1.0002 covers |d| and these roundings.
  return {-float_above(1.0002 * 1.7321 * per_distance), -float_above(1.0002 * constant),
          float_above(1.4 * L), 0};
}

LeafBound leaf_bound(std::span<const LaneCorners> lanes) {
  double longest = 0.0, error = 0.0;
  for (const LaneCorners& lane : lanes) {
    const Vec3d a(lane.a), ab = Vec3d(lane.b) - a, ac = Vec3d(lane.c) - a;
    longest = std::max({longest, dot(ab, ab), dot(ac, ac)});
    error = std::max(error, lane.error);
  }
  return leaf_bound(longest, error);
}

}  // namespace strahl
