// io/spd_lattice.cpp - SPD "lattice": balls at grid points, bars between neighbours.
#include <cstdint>
#include <utility>

#include <strahl/io/spd.h>
#include <strahl/io/spd_parts.h>

namespace strahl {
namespace {

struct Lattice {
  NffScene scene;
  int size;
  double ball_radius, bar_radius;

  Vec3d node(int i, int j, int k) const {
    const auto n = static_cast<double>(size);
    return {i / n, j / n, k / n};
  }

  // Fills 0, 1, 2 are those of bars along x, y, z, fill 3 that of the balls.
  void add_fills() {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d color{0.1, 0.1, 0.1};
      color[axis] = 0.9;
      scene.add_fill({color, 0.99, 0.0, spd::kDull, 0.0, 0.0});
    }
    scene.add_fill({{0.9, 0.9, 0.9}, 0.5, 0.5, spd::kGlossy, 0.0, 0.0});
  }

  // The bar to the next node along an axis, from just inside one ball to just inside the other.
  void add_bar(Vec3d from, Vec3d to, int axis) {
    from[axis] += 0.495 * ball_radius;
    to[axis] -= 0.495 * ball_radius;
    scene.current_fill = static_cast<std::uint32_t>(axis);
    scene.add_cone({from, bar_radius, to, bar_radius});
  }

  void add_node(int i, int j, int k) {
    const Vec3d here = node(i, j, k);
    scene.current_fill = 3;
    scene.add_sphere(here, ball_radius);
    if (i < size) add_bar(here, node(i + 1, j, k), 0);
    if (j < size) add_bar(here, node(i, j + 1, k), 1);
    if (k < size) add_bar(here, node(i, j, k + 1), 2);
  }
};

}  // namespace

NffScene spd_lattice(int size) {
  const int middle = size / 2;
  const double x = (middle + 0.5) / size, half_cell = 0.5 / size;
  Lattice lattice{
      spd::stage({x, 1.0, 1.0 - half_cell}, {x, -1.0, -1.0 - half_cell}, {0.2, 1, 0}, 60.0, 0.0,
                 {{2, 0.5, 0.5},
                  {-1, 0.5, 0.5},
                  {0.5, 2, 0.5},
                  {0.5, -1, 0.5},
                  {0.5, 0.5, 2},
                  {0.5, 0.5, -1}}),
      size, 1.0 / (4.0 * size), 1.0 / (16.0 * size)};
  lattice.add_fills();
  for (int i = 0; i <= size; ++i) {
    for (int j = 0; j <= size; ++j) {
      for (int k = 0; k <= size; ++k) lattice.add_node(i, j, k);
    }
  }
  return std::move(lattice.scene);
}

}  // namespace strahl
