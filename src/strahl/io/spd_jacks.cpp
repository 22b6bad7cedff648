// io/spd_jacks.cpp - SPD "jacks": three crossed bars with knobs, eight half-size copies of it
// around it, and so on.
#include <array>

#include <strahl/io/spd.h>
#include <strahl/io/spd_parts.h>

namespace strahl {
namespace {

constexpr double kScale = 0.75;

struct Jacks {
  NffScene& scene;
  Affine turn;

  // One jack around `center`, `scale` times the size of the largest, then its copies.
  void add(int levels, const Vec3d& center, double scale) {
    if (levels == 0) return;
    std::array<Vec3d, 6> ends;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d arm;
      arm[axis] = kScale * scale;
      ends[static_cast<std::size_t>(axis)] = turn.vector(center + arm);
      ends[static_cast<std::size_t>(axis) + 3] = turn.vector(center - arm);
    }
    const double bar = 0.1 * kScale * scale, knob = 0.2 * kScale * scale;
    for (std::size_t i = 0; i < 3; ++i) scene.add_cone({ends[i + 3], bar, ends[i], bar});
    for (const Vec3d& end : ends) scene.add_sphere(end, knob);
    for (int octant = 0; octant < 8; ++octant) {
      const auto side = [&](int bit) { return (octant & bit) != 0 ? 0.5 * scale : -0.5 * scale; };
      add(levels - 1, center + Vec3d{side(4), side(2), side(1)}, 0.5 * scale);
    }
  }
};

}  // namespace

NffScene spd_jacks(int size) {
  NffScene scene = spd::stage({0, 0, -8}, {0, 0, 0}, {0, 1, 0}, 25.0, 0.001, {{-10, 3, -20}});
  scene.background = Vec3d{0.2, 0.05, 0.2};
  scene.view->width = scene.view->height = 256;
  scene.add_fill({{0.737, 0.561, 0.561}, 0.7, 0.7, 11.1434, 0.0, 1.0});
  const Affine turn =
      spd::rotation(0, -30.0 * spd::kPi / 180.0) * spd::rotation(1, -20.0 * spd::kPi / 180.0);
  Jacks{scene, turn}.add(size, {0, 0, 0}, 1.0);
  return scene;
}

}  // namespace strahl
