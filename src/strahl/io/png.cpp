// io/png.cpp - PNG through libpng's simplified interface, which reports errors by return value and
// so never jumps over destructors.
#include <cmath>
#include <vector>

#include <png.h>

#include <strahl/base/error.h>
#include <strahl/io/atomic_file.h>
#include <strahl/io/png.h>

namespace strahl {

std::uint8_t srgb8(float linear) {
  if (!(linear > 0.0f)) return 0;
  if (linear >= 1.0f) return 255;
  // IEC 61966-2-1: linear near black, a power above.
  const double x = linear;
  const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * encoded));
}

void write_png(const std::filesystem::path& path, const Image& image) {
  require_complete(image, path.string());
  std::vector<std::uint8_t> pixels;
  pixels.reserve(image.rgb.size());
  for (const float value : image.rgb) pixels.push_back(srgb8(value));
  AtomicFile file(path);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  if (png_image_write_to_stdio(&png, file.stream(), 0, pixels.data(), 0, nullptr) == 0) {
    throw Error(ErrorCode::resource, std::string("cannot write: ") + png.message, path.string());
  }
  file.commit();
}

}  // namespace strahl
