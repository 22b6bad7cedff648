// io/exr.cpp - OpenEXR frame buffers over the channels of an image, for writing and reading.
#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <strahl/base/error.h>
#include <strahl/io/atomic_file.h>
#include <strahl/io/exr.h>

namespace strahl {
namespace {

constexpr int kNoThreads = 0;
constexpr const char* kColours[] = {"R", "G", "B"};

/// A slice over values that lie `values_per_pixel` apart; used for writing and reading alike.
template <class T>
Imf::Slice slice(Imf::PixelType type, const T* first, std::size_t values_per_pixel, int width) {
  const std::size_t pixel_bytes = values_per_pixel * sizeof(T);
  return Imf::Slice(type, reinterpret_cast<char*>(const_cast<T*>(first)), pixel_bytes,
                    pixel_bytes * static_cast<std::size_t>(width));
}

Imf::FrameBuffer frame_buffer(const Image& image) {
  Imf::FrameBuffer buffer;
  for (std::size_t i = 0; i < 3; ++i) {
    buffer.insert(kColours[i], slice(Imf::FLOAT, image.rgb.data() + i, 3, image.width));
  }
  for (const ImageChannel<float>& channel : image.float_channels) {
    buffer.insert(channel.name, slice(Imf::FLOAT, channel.values.data(), 1, image.width));
  }
  for (const ImageChannel<std::uint32_t>& channel : image.uint_channels) {
    buffer.insert(channel.name, slice(Imf::UINT, channel.values.data(), 1, image.width));
  }
  return buffer;
}

Imf::Header header_of(const Image& image, const Imf::FrameBuffer& buffer) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (auto slot = buffer.begin(); slot != buffer.end(); ++slot) {
    header.channels().insert(slot.name(), Imf::Channel(slot.slice().type));
  }
  return header;
}

bool is_colour(const std::string& name) { return name == "R" || name == "G" || name == "B"; }

/// Refuses windows that do not begin at 0, 0 and sizes that no file of this many bytes can hold.
void require_plausible(const Imath::Box2i& window, std::uintmax_t file_bytes) {
  constexpr std::uintmax_t kBestCompression = 1032;  // of deflate
  if (window.min != Imath::V2i(0)) throw std::runtime_error("data window not at 0, 0");
  const auto width = static_cast<std::uintmax_t>(window.max.x) + 1;
  const auto height = static_cast<std::uintmax_t>(window.max.y) + 1;
  if (width * height > file_bytes * kBestCompression) {
    throw std::runtime_error(std::to_string(width) + " x " + std::to_string(height) +
                             " pixels in a file of " + std::to_string(file_bytes) + " bytes");
  }
}

/// An image with room for every channel of the file.
Image empty_image(const Imf::Header& header) {
  const Imath::Box2i& window = header.dataWindow();
  Image image;
  image.width = window.max.x + 1;
  image.height = window.max.y + 1;
  const std::size_t pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.rgb.resize(3 * pixels);
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    const std::string name = channel.name();
    if (is_colour(name)) continue;
    if (channel.channel().type == Imf::UINT) {
      image.uint_channels.push_back({name, std::vector<std::uint32_t>(pixels)});
    } else {
      image.float_channels.push_back({name, std::vector<float>(pixels)});
    }
  }
  return image;
}

}  // namespace

void write_exr(const std::filesystem::path& path, const Image& image) {
  require_complete(image, path.string());
  AtomicFile file(path);
  try {
    const Imf::FrameBuffer buffer = frame_buffer(image);
    Imf::OutputFile output(file.path().c_str(), header_of(image, buffer), kNoThreads);
    output.setFrameBuffer(buffer);
    output.writePixels(image.height);
  } catch (const std::exception& error) {
    throw Error(ErrorCode::resource, std::string("cannot write: ") + error.what(), path.string());
  }
  file.commit();
}

Image read_exr(const std::filesystem::path& path) {
  try {
    Imf::InputFile input(path.c_str(), kNoThreads);
    require_plausible(input.header().dataWindow(), std::filesystem::file_size(path));
    Image image = empty_image(input.header());
    input.setFrameBuffer(frame_buffer(image));
    input.readPixels(0, image.height - 1);
    return image;
  } catch (const std::exception& error) {
    throw Error(ErrorCode::bad_input, std::string("cannot read: ") + error.what(), path.string());
  }
}

}  // namespace strahl
