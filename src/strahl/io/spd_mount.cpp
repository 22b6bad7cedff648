// io/spd_mount.cpp - SPD "mount": a fractal mountain below four glass balls.
//
// Heights come from midpoint subdivision with a random number that depends only on the place in the
// grid: the repeating hash of the original, on which all published figures rest.
#include <array>
#include <cmath>
#include <cstdint>

#include <strahl/io/spd.h>
#include <strahl/io/spd_parts.h>

namespace strahl {
namespace {

// The square root of two as the original rounds it: its digits show in the published heights.
constexpr double kDiagonal = 1.4142136;

struct Corner {
  int x, y;  // grid position
  double height;
};

class Mountain {
 public:
  Mountain(NffScene& scene, int size)
      : scene_(scene),
        size_(size),
        step_(2.0 / (1 << size)),
        roughness_(std::sqrt(std::cbrt(2.0) - 1.0)) {}

  // The square with these corners (counter-clockwise from the lower left), subdivided.
  void add(const Corner& ll, const Corner& lr, const Corner& ur, const Corner& ul) {
    const int half = (lr.x - ll.x) / 2;
    if (half == 0) {
      scene_.add_polygon(std::array<Vec3d, 3>{point(ll), point(lr), point(ur)});
      scene_.add_polygon(std::array<Vec3d, 3>{point(ur), point(ul), point(ll)});
      return;
    }
    const double amplitude = half * step_ * roughness_;
    const auto raised = [&](int x, int y, double mean, double factor) {
      return Corner{x, y, mean + factor * amplitude * gaussian(x, y)};
    };
    const auto middle = [&](const Corner& a, const Corner& b) {
      return raised((a.x + b.x) / 2, (a.y + b.y) / 2, (a.height + b.height) / 2.0, 1.0);
    };
    const Corner bottom = middle(ll, lr), right = middle(lr, ur);
    const Corner top = middle(ul, ur), left = middle(ll, ul);
    const double mean = (ll.height + lr.height + ur.height + ul.height) / 4.0;
    const Corner center = raised(ll.x + half, ll.y + half, mean, kDiagonal);
    add(ll, bottom, center, left);
    add(bottom, lr, right, center);
    add(center, right, ur, top);
    add(left, center, top, ul);
  }

 private:
  Vec3d point(const Corner& c) const { return {-1.0 + c.x * step_, -1.0 + c.y * step_, c.height}; }

  std::uint32_t seed(int x, int y) const {
    // The last term is shifted out altogether in grids finer than 2^7.
    const auto ux = static_cast<std::uint32_t>(x), uy = static_cast<std::uint32_t>(y);
    const std::uint32_t last = size_ <= 7 ? ux << (7 - size_) : 0;
    return 21 + (((ux << (23 - size_)) + (uy << (15 - size_)) + last) & 0xffffu);
  }

  // Polar method over a linear congruential generator started at the seed of the place.
  double gaussian(int x, int y) const {
    const auto next = [](std::uint32_t i) { return (28411 + 8121 * i) % 134456; };
    const auto uniform = [](std::uint32_t i) { return 2.0 * i / 134456.0 - 1.0; };
    std::uint32_t second = seed(x, y);
    while (true) {
      const std::uint32_t first = next(second);
      second = next(first);
      const double v1 = uniform(first), v2 = uniform(second);
      const double r = v1 * v1 + v2 * v2;
      if (r < 1.0) return v1 * std::sqrt(-2.0 * std::log(r) / r);
    }
  }

  NffScene& scene_;
  int size_;
  double step_;
  double roughness_;  ///< of the original's fractal dimension 2.2
};

// Four touching balls at the corners of a regular tetrahedron around a point above the mountain.
void add_glass_balls(NffScene& scene) {
  const Vec3d center{-0.8, 0.8, 1.0};
  const double radius = 0.17;
  const double reach = 2.0 * radius * std::sqrt(3.0 / 8.0);  // centre to corner
  const double base_reach = 2.0 * radius / std::sqrt(3.0);   // the same seen from above
  scene.add_fill({{1, 1, 1}, 0.1, 0.1, 101.148, 0.9, 1.5});
  scene.add_sphere(center + Vec3d{0.0, 0.0, reach}, radius);
  for (int k = 0; k < 3; ++k) {
    const double angle = -0.25 * spd::kPi + k * 2.0 * spd::kPi / 3.0;
    scene.add_sphere(
        center + Vec3d{base_reach * std::cos(angle), base_reach * std::sin(angle), -reach / 3.0},
        radius);
  }
}

}  // namespace

NffScene spd_mount(int size) {
  NffScene scene =
      spd::stage({-1.6, 1.6, 1.7}, {0, 0, 0}, {0, 0, 1}, 45.0, 0.01, {{-100, -100, 100}});
  add_glass_balls(scene);
  scene.add_fill({{0.5, 0.45, 0.35}, 1.0, 0.0, spd::kDull, 0.0, 0.0});
  const int n = 1 << size;
  Mountain(scene, size).add({0, 0, 0.0}, {n, 0, 0.0}, {n, n, 0.0}, {0, n, 0.0});
  return scene;
}

}  // namespace strahl
