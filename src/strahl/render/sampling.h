// render/sampling.h - well-spread sample points and directions, the same on every machine but for
// libm's last digits.
//
// Points are the Hammersley set shifted per pixel [Cranley1976]: even within a pixel, unrelated
// between pixels.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <strahl/base/rng.h>
#include <strahl/math/vec3.h>

namespace strahl {

/// A point of the unit square.
struct Sample2 {
  double x, y;
};

/// The bits of i mirrored about the binary point, in [0, 1).
inline double radical_inverse(std::uint32_t i) {
  i = (i << 16) | (i >> 16);
  i = ((i & 0x00ff00ffu) << 8) | ((i & 0xff00ff00u) >> 8);
  i = ((i & 0x0f0f0f0fu) << 4) | ((i & 0xf0f0f0f0u) >> 4);
  i = ((i & 0x33333333u) << 2) | ((i & 0xccccccccu) >> 2);
  i = ((i & 0x55555555u) << 1) | ((i & 0xaaaaaaaau) >> 1);
  return i * 0x1p-32;
}

/// Point i of n, shifted (modulo 1) by `shift`.
inline Sample2 spread_sample(std::uint32_t i, std::uint32_t n, Sample2 shift) {
  const double x = (i + 0.5) / n + shift.x, y = radical_inverse(i) + shift.y;
  return {x - std::floor(x), y - std::floor(y)};
}

/// A shift for pixel (x, y): neighbours get shifts far apart (multiples of powers of the plastic
/// number), which looks smoother than noise. `start` moves the whole pattern.
inline Sample2 pixel_shift(int x, int y, Sample2 start) {
  const double a = start.x + 0.7548776662466927 * x + 0.5698402909980532 * y;
  const double b = start.y + 0.5698402909980532 * x + 0.3247179572447460 * y;
  return {a - std::floor(a), b - std::floor(b)};
}

inline Sample2 random_sample(Rng& rng) {
  const double x = rng.uniform();
  return {x, rng.uniform()};
}

/// A unit vector around the unit `normal`, its density proportional to the cosine.
inline Vec3d cosine_direction(const Vec3d& normal, Sample2 s) {
  const double radius = std::sqrt(s.x), turn = 2.0 * std::numbers::pi * s.y;
  const Vec3d axis = std::abs(normal.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d tangent = normalized(cross(axis, normal)), bitangent = cross(normal, tangent);
  return radius * std::cos(turn) * tangent + radius * std::sin(turn) * bitangent +
         std::sqrt(1.0 - s.x) * normal;
}

}  // namespace strahl
