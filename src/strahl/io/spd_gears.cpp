// io/spd_gears.cpp - SPD "gears": a cube of meshing gears, some of glass, over a mirror.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <strahl/io/spd.h>
#include <strahl/io/spd_parts.h>

namespace strahl {
namespace {

constexpr int kTeeth = 36;
constexpr std::size_t kCorners = std::size_t{4} * kTeeth;
constexpr double kRimGap = 0.05;  // how far neighbouring gears interlock, of the radius

struct Gear {
  Vec3d center;  // of the upper face
  double offset_angle, outer_radius, inner_radius, thickness;
};

// The outline of a face, counter-clockwise (turn = 1) or clockwise (turn = -1) seen from above.
std::array<Vec3d, kCorners> outline(const Gear& gear, double turn, double drop) {
  const double pitch = turn * (2.0 * spd::kPi / kTeeth);
  const std::array<double, 4> fraction{-0.19, 0.19, 0.3, 0.7};
  std::array<Vec3d, kCorners> corners;
  for (std::size_t i = 0; i < kCorners; ++i) {
    const double radius = i % 4 < 2 ? gear.outer_radius : gear.inner_radius;
    const std::size_t tooth = i / 4;
    const double begin =
        gear.offset_angle + turn * 2.0 * spd::kPi * static_cast<double>(tooth) / kTeeth;
    const double angle = begin + fraction[i % 4] * pitch;
    corners[i] = Vec3d{radius * std::cos(angle), radius * std::sin(angle), -drop} + gear.center;
  }
  return corners;
}

void add_gear(NffScene& scene, const Gear& gear) {
  const std::array<Vec3d, kCorners> top = outline(gear, 1.0, 0.0);
  scene.add_polygon(top);
  const Vec3d down{0.0, 0.0, gear.thickness};
  for (std::size_t i = 0; i < kCorners; ++i) {
    const Vec3d& next = top[(i + 1) % kCorners];
    scene.add_polygon(std::array<Vec3d, 4>{top[i], top[i] - down, next - down, next});
  }
  scene.add_polygon(outline(gear, -1.0, gear.thickness));
}

// A colour from the place in the cube, brightest channel 1; every fifth gear is glass.
Material gear_fill(int ix, int iy, int iz) {
  const auto channel = [](int place, double factor) {
    const double x = place * factor / 7.0;
    return 0.01 + (x - std::floor(x));
  };
  const Vec3d raw{channel(3 * ix + 2 * iy + iz + 1, 5.0), channel(3 * iy + 2 * iz + ix + 1, 3.0),
                  channel(3 * iz + 2 * ix + iy + 1, 2.0)};
  const Vec3d color = raw / std::max({raw.x, raw.y, raw.z});
  const bool glass = (4 * ix + 2 * iy + iz) % 5 == 0;
  return glass ? Material{color, 0.2, 0.0, spd::kDull, 0.8, 1.1}
               : Material{color, 1.0, 0.0, spd::kDull, 0.0, 0.0};
}

}  // namespace

NffScene spd_gears(int size) {
  NffScene scene =
      spd::stage({-1.1, -2.1, 2.6}, {0, 0, 0}, {0, 0, 1}, 45.0, 1.0,
                 {{2, 4, 4}, {-2, 4, 3}, {2, -2.5, 2.5}, {-1, -4, 2}, {-1.111, -2.121, 2.626}});
  scene.add_fill({{1.0, 0.85, 0.7}, 0.3, 0.6, spd::kGlossy, 0.0, 0.0});
  spd::add_ground(scene, 2.0, 0.0);

  const double radius = 1.0 / (size - (size - 1) * kRimGap);
  const double step = radius * (2.0 - 2.0 * kRimGap);
  const double first = -1.0 + radius;
  const double thickness = std::min(0.1, 1.0 / (2.0 * size));
  for (int iz = 0; iz < size; ++iz) {
    for (int iy = 0; iy < size; ++iy) {
      for (int ix = 0; ix < size; ++ix) {
        scene.add_fill(gear_fill(ix, iy, iz));
        add_gear(scene, {{first + ix * step, first + iy * step, 1.0 + iz * (-1.0 / size)},
                         spd::kPi * ((ix + iy + iz) % 2) / kTeeth,
                         0.995 * radius,
                         0.9 * radius,
                         thickness});
      }
    }
  }
  return scene;
}

}  // namespace strahl
