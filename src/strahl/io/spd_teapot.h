// io/spd_teapot.h - the teapot's tessellation, which the stadium scene uses too.
#pragma once

#include <array>
#include <vector>

#include <strahl/math/vec3.h>

namespace strahl::spd {

/// A triangle of the teapot with its surface normals.
struct TeapotTriangle {
  std::array<Vec3d, 3> corners, normals;
};

/// 64 steps^2 - 8 steps triangles: every patch cut into steps x steps cells of two; those that
/// collapse at the tip of the lid or of the bottom are left out. z up, standing near z = 0, about
/// 6.4 x 4 x 3.15 units. steps >= 1.
std::vector<TeapotTriangle> tessellate_teapot(int steps);

}  // namespace strahl::spd
