// render/heat_map.h - pictures of one number per pixel, and of the difference of two such.
//
// Colours are linear RGB, 3 floats per pixel, 1 is white.
// Thread safety: pure functions.
#pragma once

#include <span>
#include <vector>

#include <strahl/io/image.h>
#include <strahl/math/vec3.h>

namespace strahl {

/// The value that half a percent of the values exceed: a few extreme rays do not set the scale.
/// Values that are not finite do not count. 0 without any.
double heat_scale(std::vector<float> values);

/// Dark blue over red to white for values 0..scale.
std::vector<float> heat_map(std::span<const float> values, double scale);

/// White where both are alike, blue where a is less by up to `scale`, red where it is more.
/// @param a,b as many values
std::vector<float> difference_map(std::span<const float> a, std::span<const float> b, double scale);

void set_pixel(Image& image, std::size_t pixel, const Vec3d& color);

}  // namespace strahl
