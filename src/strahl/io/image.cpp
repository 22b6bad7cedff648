// io/image.cpp - the check every image writer begins with.
#include <cstddef>
#include <set>

#include <strahl/base/error.h>
#include <strahl/io/image.h>

namespace strahl {
namespace {

[[noreturn]] void refuse(const std::string& reason, const std::string& which) {
  throw Error(ErrorCode::usage, reason, which);
}

template <class T>
void require_channels(const std::vector<ImageChannel<T>>& channels, std::size_t pixels,
                      std::set<std::string>& names, const std::string& which) {
  for (const ImageChannel<T>& channel : channels) {
    const std::string name = "image channel '" + channel.name + "'";
    if (channel.name.empty() || !names.insert(channel.name).second) {
      refuse(name + " has no name of its own", which);
    }
    if (channel.values.size() != pixels) {
      refuse(name + " has " + std::to_string(channel.values.size()) + " values for " +
                 std::to_string(pixels) + " pixels",
             which);
    }
  }
}

}  // namespace

void require_complete(const Image& image, const std::string& which) {
  if (image.width < 1 || image.height < 1) {
    refuse("image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
               " pixels",
           which);
  }
  const std::size_t pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.rgb.size() != 3 * pixels) {
    refuse("image has " + std::to_string(image.rgb.size()) + " colour values for " +
               std::to_string(pixels) + " pixels",
           which);
  }
  std::set<std::string> names{"R", "G", "B"};
  require_channels(image.float_channels, pixels, names, which);
  require_channels(image.uint_channels, pixels, names, which);
}

}  // namespace strahl
