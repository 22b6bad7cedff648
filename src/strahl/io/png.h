// io/png.h - images as 8-bit sRGB PNG, for looking at.
#pragma once

#include <cstdint>
#include <filesystem>

#include <strahl/io/image.h>

namespace strahl {

/// A linear value as 8-bit sRGB, rounded to nearest; below 0 and NaN give 0, above 1 gives 255.
std::uint8_t srgb8(float linear);

/// Writes the colour of the image; other channels are left out. The file appears when complete.
/// Throws Error{usage} for an incomplete image, Error{resource} when it cannot be written.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace strahl
