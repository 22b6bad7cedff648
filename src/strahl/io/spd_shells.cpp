// io/spd_shells.cpp - SPD "shells": overlapping spheres along a growing spiral.
#include <cmath>

#include <strahl/io/spd.h>
#include <strahl/io/spd_parts.h>

namespace strahl {

NffScene spd_shells(int size) {
  NffScene scene =
      spd::stage({-6, -60, 35}, {0, 8, -15}, {0, 0, 1}, 45.0, 0.5, {{-100, -100, 100}});
  scene.add_fill({{1.0, 0.8, 0.4}, 0.8, 0.2, 45.2776, 0.0, 1.0});
  const int steps = 180 << size;
  for (int i = -2 * steps / 3; i <= steps / 3; ++i) {
    const double angle = 18.0 * spd::kPi * i / steps;
    const double radius = std::exp(0.15 * angle);
    scene.add_sphere({radius * std::sin(angle), radius * std::cos(angle), -2.0 * radius}, radius);
  }
  return scene;
}

}  // namespace strahl
