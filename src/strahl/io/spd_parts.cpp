// io/spd_parts.cpp - what several of the SPD scenes share.
#include <array>
#include <cmath>
#include <cstddef>

#include <strahl/io/spd_parts.h>

namespace strahl::spd {

Affine rotation(int axis, double radians) {
  const double c = std::cos(radians), s = std::sin(radians);
  const auto i = static_cast<std::size_t>((axis + 1) % 3);
  const auto j = static_cast<std::size_t>((axis + 2) % 3);
  Affine a;
  a.m[i][i] = c, a.m[i][j] = -s;
  a.m[j][i] = s, a.m[j][j] = c;
  return a;
}

NffScene stage(const Vec3d& from, const Vec3d& at, const Vec3d& up, double fov_degrees,
               double hither, std::initializer_list<Vec3d> lights) {
  NffScene scene;
  scene.background = Vec3d{0.078, 0.361, 0.753};
  scene.view = View{from, at, up, fov_degrees, 512, 512};
  scene.hither = hither;
  scene.lights = lights;
  return scene;
}

void add_ground(NffScene& scene, double half, double z) {
  scene.add_polygon(std::array<Vec3d, 4>{
      Vec3d{half, half, z}, {-half, half, z}, {-half, -half, z}, {half, -half, z}});
}

}  // namespace strahl::spd
