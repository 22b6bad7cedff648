// io/spd_rings.cpp - SPD "rings": a pyramid of objects of six pentagonal rings, each ring round the
// edge midpoints of a dodecahedron.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <strahl/io/spd.h>
#include <strahl/io/spd_parts.h>

namespace strahl {
namespace {

constexpr double kTubeRadius = 0.07412;

using Ring = std::array<Vec3d, 5>;

// The rings of an object in a sphere of radius 1: one around z, five tilted against it.
std::array<Ring, 6> make_rings() {
  std::array<Ring, 6> rings;
  const double radius = 1.0 / (1.0 + kTubeRadius);
  for (std::size_t k = 0; k < 5; ++k) {
    const double angle = static_cast<double>(k) * 2.0 * spd::kPi / 5.0;
    rings[0][k] = {radius * std::cos(angle), radius * std::sin(angle), 0.0};
  }
  // Angle between neighbouring faces of a dodecahedron, seen from outside.
  const Affine tilt =
      spd::rotation(0, 2.0 * std::acos(std::cos(spd::kPi / 3.0) / std::sin(spd::kPi / 5.0)));
  for (std::size_t r = 1; r < 6; ++r) {
    const Affine turn = spd::rotation(2, spd::kPi * (2.0 * static_cast<double>(r - 1) + 1.0) / 5.0);
    for (std::size_t k = 0; k < 5; ++k) rings[r][k] = turn.vector(tilt.vector(rings[0][k]));
  }
  return rings;
}

constexpr std::array<Vec3d, 6> kColors{Vec3d{1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                       {0, 1, 1},      {1, 0, 1}, {1, 1, 0}};

// The fills of the rings are those from first_fill on.
void add_object(NffScene& scene, const std::array<Ring, 6>& rings, std::uint32_t first_fill,
                const Vec3d& center) {
  for (std::size_t r = 0; r < 6; ++r) {
    scene.current_fill = first_fill + static_cast<std::uint32_t>(r);
    for (std::size_t k = 0; k < 5; ++k) {
      const Vec3d here = rings[r][k] + center, previous = rings[r][(k + 4) % 5] + center;
      scene.add_cone({here, kTubeRadius, previous, kTubeRadius});
      scene.add_sphere(here, kTubeRadius);
    }
  }
}

// A white square behind the last layer that just fills the view.
void add_backdrop(NffScene& scene, const Vec3d& eye, double y) {
  const double half = 1.01 * (y - eye.y) * std::tan(spd::kPi / 8.0);
  scene.add_fill({{1, 1, 1}, 1.0, 0.0, spd::kDull, 0.0, 0.0});
  scene.add_polygon(std::array<Vec3d, 4>{Vec3d{half + eye.x, y, half + eye.z},
                                         {-half + eye.x, y, half + eye.z},
                                         {-half + eye.x, y, -half + eye.z},
                                         {half + eye.x, y, -half + eye.z}});
}

}  // namespace

NffScene spd_rings(int size) {
  const double spread = 1.0 / std::sin(spd::kPi / 8.0);  // from layer to layer
  const Vec3d eye{-1.0, -spread, 0.5};
  NffScene scene = spd::stage(eye, eye + Vec3d{0, 1, 0}, {0, 0, 1}, 45.0, 1.0,
                              {{3, -spread, 3}, {-4, -spread, 1}, {2, -spread, -4}});
  add_backdrop(scene, eye, spread * (size + 1));
  const auto first_fill = static_cast<std::uint32_t>(scene.fills.size());
  for (const Vec3d& color : kColors) {
    scene.add_fill({color, 0.5, 0.2, spd::kGlossy, 0.0, 0.0});
  }
  const std::array<Ring, 6> rings = make_rings();
  for (int layer = 0; layer < size; ++layer) {
    for (int z = 0; z <= layer; ++z) {
      for (int x = 0; x <= layer; ++x) {
        add_object(scene, rings, first_fill,
                   {static_cast<double>(2 * x - layer), spread * (layer + 1),
                    static_cast<double>(2 * z - layer)});
      }
    }
  }
  return scene;
}

}  // namespace strahl
