// io/spd_sombrero.cpp - SPD "sombrero": a damped cosine of the distance from the axis.
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <strahl/io/spd.h>
#include <strahl/io/spd_parts.h>

namespace strahl {
namespace {

// n x n heights, x fastest. Sampled at -4 + 8 i/n but (as in the original) later drawn at
// -4 + 8 i/(n-1), so the brim is slightly off centre.
std::vector<double> sample_heights(std::size_t n) {
  std::vector<double> heights;
  const auto sample = [n](std::size_t i) {
    return -4.0 + 8.0 * static_cast<double>(i) / static_cast<double>(n);
  };
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i) {
      const double x = sample(i), z = sample(j);
      const double distance = std::sqrt(x * x + z * z);
      heights.push_back(-3.0 + std::cos(2.0 * spd::kPi * distance) * std::exp(-distance));
    }
  }
  return heights;
}

}  // namespace

NffScene spd_sombrero(int size) {
  NffScene scene = spd::stage({0, 5, -8}, {0, 0, 0}, {0, 0, 1}, 40.0, 0.01, {{10, 10, -10}});
  scene.add_fill({{1.0, 0.1, 0.1}, 0.8, 0.0, 2.60078, 0.0, 1.0});
  const std::size_t n = std::size_t{32} << (size - 1);
  const std::vector<double> heights = sample_heights(n);
  const auto point = [&](std::size_t i, std::size_t j) {
    const auto place = [n](std::size_t k) {
      return -4.0 + 8.0 * static_cast<double>(k) / static_cast<double>(n - 1);
    };
    return Vec3d{place(i), heights[j * n + i], place(j)};
  };
  for (std::size_t j = 0; j + 1 < n; ++j) {
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const Vec3d a = point(i, j), b = point(i + 1, j), c = point(i + 1, j + 1);
      scene.add_polygon(std::array<Vec3d, 3>{a, c, b});
      scene.add_polygon(std::array<Vec3d, 3>{a, point(i, j + 1), c});
    }
  }
  return scene;
}

}  // namespace strahl
