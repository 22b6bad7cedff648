#include <apps/strahl/arguments.h>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include <strahl/base/error.h>

namespace strahl::cli {
namespace {

constexpr int kMaxImageSide = 32768;

[[noreturn]] void refuse(std::string_view text, const char* option, const char* expected) {
  throw Error(ErrorCode::usage, "got '" + std::string(text) + "', expected " + expected, option);
}

/// The whole of text as a number.
template <class T>
std::optional<T> parse(std::string_view text) {
  T value{};
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end) return std::nullopt;
  return value;
}

/// What stands before the first separator; text keeps what follows it.
std::string_view cut(std::string_view& text, char separator) {
  const std::size_t at = text.find(separator);
  const std::string_view head = text.substr(0, at);
  text = at == std::string_view::npos ? std::string_view() : text.substr(at + 1);
  return head;
}

}  // namespace

std::uint64_t parse_bytes(std::string_view text, const char* option) {
  static constexpr const char* kExpected = "bytes such as 1000000, 512K, 64M or 2G";
  constexpr std::string_view kSuffixes = "kmgKMG";
  const std::size_t suffix = text.empty() ? std::string_view::npos : kSuffixes.find(text.back());
  const bool has_suffix = suffix != std::string_view::npos;
  const auto value = parse<std::uint64_t>(text.substr(0, text.size() - has_suffix));
  const unsigned shift = has_suffix ? 10 * (static_cast<unsigned>(suffix) % 3 + 1) : 0;
  if (!value || *value > (UINT64_MAX >> shift)) refuse(text, option, kExpected);
  return *value << shift;
}

ImageSize parse_image_size(std::string_view text, const char* option) {
  std::string_view rest = text;
  const auto width = parse<int>(cut(rest, 'x'));
  const auto height = parse<int>(rest);
  for (const std::optional<int>& side : {width, height})
    if (!side || *side < 1 || *side > kMaxImageSide)
      refuse(text, option, "WIDTHxHEIGHT, each 1..32768, such as 640x480");
  return {*width, *height};
}

Vec3d parse_vector(std::string_view text, const char* option) {
  std::string_view rest = text;
  Vec3d v;
  for (int axis = 0; axis < 3; ++axis) {
    const auto value = parse<double>(axis < 2 ? cut(rest, ',') : rest);
    if (!value || !std::isfinite(*value)) refuse(text, option, "x,y,z such as 1,-2.5,0");
    v[axis] = *value;
  }
  return v;
}

}  // namespace strahl::cli
