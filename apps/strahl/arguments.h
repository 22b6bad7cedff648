// apps/strahl/arguments.h - values of options: sizes, vectors, amounts of memory.
#pragma once

#include <cstdint>
#include <string_view>

#include <strahl/math/vec3.h>

namespace strahl::cli {

/// "64", "512K", "2G": bytes with an optional suffix K, M or G (powers of 1024) in any case.
/// All functions throw Error{usage} naming the option, what was got and what is expected.
std::uint64_t parse_bytes(std::string_view text, const char* option);

struct ImageSize {
  int width, height;
};
/// "640x480", each 1..32768.
ImageSize parse_image_size(std::string_view text, const char* option);

/// "x,y,z", finite.
Vec3d parse_vector(std::string_view text, const char* option);

}  // namespace strahl::cli
