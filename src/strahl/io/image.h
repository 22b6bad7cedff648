// io/image.h - an image in memory: linear colour and any number of named channels.
//
// Layout: row by row from the top, each row from the left; channel values at y * width + x.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace strahl {

template <class T>
struct ImageChannel {
  std::string name;  ///< as in EXR: "Z", "N.X", "primitive_id", ...
  std::vector<T> values;
};

struct Image {
  int width = 0;
  int height = 0;
  std::vector<float> rgb;  ///< linear, 3 per pixel; 1 is white
  std::vector<ImageChannel<float>> float_channels;
  std::vector<ImageChannel<std::uint32_t>> uint_channels;
};

/// Throws Error{usage}, naming the file about to be written, unless the image has at least one
/// pixel and every channel has exactly one value per pixel, a name, and no other channel's name.
void require_complete(const Image& image, const std::string& which);

}  // namespace strahl
