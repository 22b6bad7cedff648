// io/spd_tetra.cpp - SPD "tetra": Sierpinski's tetrahedron.
#include <array>

#include <strahl/io/spd.h>
#include <strahl/io/spd_parts.h>

namespace strahl {
namespace {

// The tetrahedron on alternate corners of the cube `center` +- `half`.
void add_tetra(NffScene& scene, int levels, const Vec3d& center, double half) {
  const double child = levels == 1 ? half : 0.5 * half;
  const std::array<Vec3d, 4> corners{
      center + Vec3d{-child, -child, child}, center + Vec3d{-child, child, -child},
      center + Vec3d{child, -child, -child}, center + Vec3d{child, child, child}};
  if (levels > 1) {
    for (const Vec3d& corner : corners) add_tetra(scene, levels - 1, corner, child);
    return;
  }
  const auto& [a, b, c, d] = corners;
  scene.add_polygon(std::array<Vec3d, 3>{a, b, c});
  scene.add_polygon(std::array<Vec3d, 3>{d, c, b});
  scene.add_polygon(std::array<Vec3d, 3>{c, d, a});
  scene.add_polygon(std::array<Vec3d, 3>{b, a, d});
}

}  // namespace

NffScene spd_tetra(int size) {
  NffScene scene = spd::stage({1.022846, -3.177154, -2.174512}, {-0.004103, -0.004103, 0.216539},
                              {-0.816497, -0.816497, 0.816497}, 45.0, 1.0, {{2, -18, -5}});
  scene.add_fill({{1.0, 0.2, 0.2}, 1.0, 0.0, spd::kDull, 0.0, 0.0});
  add_tetra(scene, size, {0, 0, 0}, 1.0);
  return scene;
}

}  // namespace strahl
