#include <array>
#include <string>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/io/gltf_buffers.h>

namespace strahl::gltf {
namespace {

constexpr unsigned kNoDigit = 64;

constexpr std::array<unsigned char, 256> base64_digits() {
  std::array<unsigned char, 256> table{};
  table.fill(kNoDigit);
  constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kAlphabet.size(); ++i)
    table[static_cast<unsigned char>(kAlphabet[i])] = static_cast<unsigned char>(i);
  return table;
}
constexpr std::array<unsigned char, 256> kBase64 = base64_digits();

unsigned base64_digit(char c) { return kBase64[static_cast<unsigned char>(c)]; }

OwnedBytes decode_data_uri(std::string_view uri, const JsonValue& place) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64"))
    place.fail("data URI without ';base64,'");
  std::optional<std::vector<std::byte>> decoded = decode_base64(uri.substr(comma + 1));
  if (!decoded) place.fail("malformed base64");
  auto owner = std::make_shared<const std::vector<std::byte>>(*std::move(decoded));
  return {{owner->data(), owner->size()}, owner};
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

// Relative references are percent-encoded: "my%20part.bin".
std::string decode_percent(std::string_view uri, const JsonValue& place) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      text += uri[i];
      continue;
    }
    const int high = i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
    const int low = i + 2 < uri.size() ? hex_digit(uri[i + 2]) : -1;
    if (high < 0 || low < 0) place.fail("malformed percent-encoding");
    text += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return text;
}

// A scene must not read what its author does not own: only files in its folder or below.
std::filesystem::path sibling_path(const std::filesystem::path& folder, const JsonValue& uri) {
  const std::string shown = "'" + printable(uri.string()) + "'";
  if (folder.empty()) uri.fail("refers to the file " + shown + ", but no folder is known");
  const std::string name = decode_percent(uri.string(), uri);
  if (name.find('\0') != std::string::npos || name.find("://") != std::string::npos)
    uri.fail(shown + " is not a file name");
  const std::filesystem::path relative = std::filesystem::path(name).lexically_normal();
  if (relative.empty() || relative.is_absolute() || *relative.begin() == "..")
    uri.fail(shown + " is not inside the folder of the file");
  return folder / relative;
}

OwnedBytes map_sibling(const std::filesystem::path& folder, const JsonValue& uri) {
  const std::filesystem::path path = sibling_path(folder, uri);
  try {
    FileBytes file = map_file(path);
    return {file.bytes, std::move(file.owner)};
  } catch (const Error& e) {
    uri.fail("file '" + printable(uri.string()) + "': " + e.reason());
  }
}

}  // namespace

std::optional<std::vector<std::byte>> decode_base64(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  text.remove_suffix(padding);
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  unsigned bits = 0, bit_count = 0;
  for (const char c : text) {
    const unsigned digit = base64_digit(c);
    if (digit == kNoDigit) return std::nullopt;
    bits = (bits << 6 | digit) & 0xFFFF;
    bit_count += 6;
    if (bit_count < 8) continue;
    bit_count -= 8;
    bytes.push_back(static_cast<std::byte>(bits >> bit_count & 0xFF));
  }
  return bytes;
}

Buffers::Buffers(Document& document) : document_(document), buffers_(document.count("buffers")) {
  for (std::size_t i = 0; i < document.count("bufferViews"); ++i) {
    const JsonValue view = document.item("bufferViews", i);
    const JsonValue buffer = document.item("buffers", view.at("buffer"));
    const std::uint64_t size = buffer.at("byteLength").integer();
    const std::uint64_t offset = integer_or(view, "byteOffset", 0);
    if (offset > size || view.at("byteLength").integer() > size - offset)
      view.fail("reaches past the " + std::to_string(size) + " bytes of its buffer");
  }
}

BufferView Buffers::view(const JsonValue& reference) {
  const JsonValue view = document_.item("bufferViews", reference);
  const OwnedBytes& whole = buffer(view.at("buffer").index(buffers_.size(), "buffers"));
  const std::size_t offset = integer_or(view, "byteOffset", 0);
  return {{whole.bytes.subspan(offset, view.at("byteLength").integer()), whole.owner},
          integer_or(view, "byteStride", 0)};
}

const OwnedBytes& Buffers::buffer(std::size_t i) {
  if (!buffers_[i]) {
    const JsonValue description = document_.item("buffers", i);
    const std::uint64_t stated = description.at("byteLength").integer();
    OwnedBytes found = fetch(i, description);
    if (found.bytes.size() < stated)
      description.fail("holds " + std::to_string(found.bytes.size()) + " bytes, not the stated " +
                       std::to_string(stated));
    found.bytes = found.bytes.first(stated);
    buffers_[i] = std::move(found);
  }
  return *buffers_[i];
}

OwnedBytes Buffers::fetch(std::size_t i, const JsonValue& description) {
  const std::optional<JsonValue> uri = description.find("uri");
  if (!uri) {
    if (i != 0 || !document_.binary()) description.fail("has no uri, and there is no BIN chunk");
    return {*document_.binary(), document_.file().owner};
  }
  if (uri->string().starts_with("data:")) return decode_data_uri(uri->string(), *uri);
  OwnedBytes found = map_sibling(document_.file().folder, *uri);
  document_.add_input(found.bytes.size());
  return found;
}

}  // namespace strahl::gltf
