// io/spd_balls.cpp - SPD "balls": every sphere carries nine of a third of its radius.
#include <array>
#include <cmath>
#include <cstddef>

#include <strahl/io/spd.h>
#include <strahl/io/spd_parts.h>

namespace strahl {
namespace {

using Directions = std::array<Vec3d, 9>;

// Turn about a unit axis by Rodrigues' formula.
Affine rotation_about(const Vec3d& axis, double radians) {
  const double c = std::cos(radians), s = std::sin(radians);
  Affine a;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      a.m[i][j] = axis[static_cast<int>(i)] * axis[static_cast<int>(j)] * (1.0 - c);
    }
    a.m[i][i] += c;
  }
  a.m[0][1] -= axis.z * s, a.m[1][0] += axis.z * s;
  a.m[0][2] += axis.y * s, a.m[2][0] -= axis.y * s;
  a.m[1][2] -= axis.x * s, a.m[2][1] += axis.x * s;
  return a;
}

// Where the nine children of a sphere lie that itself points up (+z): three at each third of a
// turn, the trio (1,1,0) (1,0,-1) (0,1,-1) tilted so that two lie on the equator.
Directions directions_around_up() {
  const Affine tilt =
      rotation_about(normalized(Vec3d{1.0, -1.0, 0.0}), std::asin(2.0 / std::sqrt(6.0)));
  const std::array<Vec3d, 3> trio{Vec3d{1.0, 1.0, 0.0}, {1.0, 0.0, -1.0}, {0.0, 1.0, -1.0}};
  Directions directions;
  for (std::size_t k = 0; k < 9; ++k) {
    const std::size_t third = k / 3;
    const Affine turn = spd::rotation(2, static_cast<double>(third) * 2.0 * spd::kPi / 3.0);
    directions[k] = turn.vector(tilt.vector(normalized(trio[k % 3])));
  }
  return directions;
}

// The rotation that takes up to `direction`.
Affine rotation_from_up(const Vec3d& direction) {
  if (direction.z >= 0.9999) return Affine{};
  if (direction.z <= -0.9999) return spd::rotation(1, spd::kPi);
  const Vec3d axis = normalized(cross(Vec3d{0.0, 0.0, 1.0}, direction));
  return rotation_about(axis, std::acos(direction.z));
}

void add_flake(NffScene& scene, int depth, const Sphere& ball, const Vec3d& direction,
               const Directions& around_up) {
  scene.add_sphere(ball.center, ball.radius);
  if (depth == 0) return;
  const Affine turn = rotation_from_up(direction);
  const double distance = ball.radius * (1.0 + 1.0 / 3.0);
  for (const Vec3d& up_direction : around_up) {
    const Vec3d child = turn.vector(up_direction);
    add_flake(scene, depth - 1, {ball.center + distance * child, ball.radius / 3.0}, child,
              around_up);
  }
}

}  // namespace

NffScene spd_balls(int size) {
  NffScene scene = spd::stage({2.1, 1.3, 1.7}, {0, 0, 0}, {0, 0, 1}, 45.0, 0.01,
                              {{4, 3, 2}, {1, -4, 4}, {-3, 1, 5}});
  scene.add_fill({{1.0, 0.75, 0.33}, 0.8, 0.0, spd::kDull, 0.0, 1.0});
  spd::add_ground(scene, 12.0, -0.5);
  scene.add_fill({{1.0, 0.9, 0.7}, 0.5, 0.5, spd::kGlossy, 0.0, 1.0});
  add_flake(scene, size, {{0, 0, 0}, 0.5}, {0, 0, 1}, directions_around_up());
  return scene;
}

}  // namespace strahl
