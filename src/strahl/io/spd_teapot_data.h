// io/spd_teapot_data.h - control points and patches of the Utah teapot (see the .cpp for credits).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace strahl::spd {

inline constexpr std::size_t kTeapotPoints = 290, kTeapotPatches = 32;

/// x, y, z; the pot stands on z = 0.
extern const std::array<std::array<double, 3>, kTeapotPoints> kTeapotPoint;
/// Indices of 4 rows of 4 control points.
extern const std::array<std::array<std::uint16_t, 16>, kTeapotPatches> kTeapotPatch;

}  // namespace strahl::spd
