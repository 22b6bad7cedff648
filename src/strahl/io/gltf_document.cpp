#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string_view>

#include <strahl/base/error.h>
#include <strahl/io/gltf_document.h>

namespace strahl::gltf {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF data is read in place");

constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN\0"
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

constexpr std::size_t kMostWarnings = 100;

// Real files stay below 10 bytes per byte (one-byte indices become 4); a crowd of skinned copies
// may need more, hence the constant part.
constexpr std::uint64_t kGrowth = 64, kFreeBytes = std::uint64_t{64} << 20;

std::uint32_t read_u32(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

[[noreturn]] void fail_container(const std::string& file, std::size_t byte,
                                 const std::string& reason) {
  throw Error(ErrorCode::bad_input, "GLB: " + reason, file, "byte " + std::to_string(byte));
}

// The bytes the header of a GLB vouches for, itself included.
std::span<const std::byte> container_bytes(const FileBytes& file) {
  const std::span<const std::byte> bytes = file.bytes;
  if (bytes.size() < kHeaderBytes) fail_container(file.name, bytes.size(), "header cut off");
  const std::uint32_t version = read_u32(bytes, 4), length = read_u32(bytes, 8);
  if (version != 2)
    fail_container(file.name, 4, "version " + std::to_string(version) + ", only 2 is supported");
  if (length > bytes.size())
    fail_container(file.name, 8,
                   "length " + std::to_string(length) + " in a file of " +
                       std::to_string(bytes.size()) + " bytes");
  return bytes.first(std::max<std::size_t>(length, kHeaderBytes));
}

struct Chunk {
  std::uint32_t type;
  std::span<const std::byte> bytes;
};

Chunk read_chunk(std::span<const std::byte> bytes, std::size_t at, const std::string& file) {
  const std::size_t left = bytes.size() - at;
  if (left < kChunkHeaderBytes) fail_container(file, at, "chunk header cut off");
  const std::uint32_t size = read_u32(bytes, at);
  if (size > left - kChunkHeaderBytes)
    fail_container(file, at, "chunk of " + std::to_string(size) + " bytes reaches past the end");
  return {read_u32(bytes, at + 4), bytes.subspan(at + kChunkHeaderBytes, size)};
}

// What changes neither positions nor topology, or is implemented.
bool is_supported(std::string_view extension) {
  constexpr std::array<std::string_view, 8> kNames{
      "KHR_mesh_quantization", "EXT_mesh_gpu_instancing", "KHR_lights_punctual",
      "KHR_texture_transform", "KHR_texture_basisu",      "EXT_texture_webp",
      "EXT_texture_avif",      "MSFT_texture_dds"};
  return extension.starts_with("KHR_materials_") ||
         std::find(kNames.begin(), kNames.end(), extension) != kNames.end();
}

}  // namespace

Document::Document(const FileBytes& file)
    : file_(file), text_(file.text()), input_bytes_(file.bytes.size()) {
  if (file.bytes.size() >= 4 && read_u32(file.bytes, 0) == kMagic) split_container();
  json_ = parse_json(text_, file_.name, text_start_);
  check_asset();
  check_extensions();
}

void Document::split_container() {
  const std::span<const std::byte> bytes = container_bytes(file_);
  bool json_seen = false;
  for (std::size_t at = kHeaderBytes; at < bytes.size();) {
    const Chunk chunk = read_chunk(bytes, at, file_.name);
    if (!json_seen && chunk.type != kJsonChunk)
      fail_container(file_.name, at + 4, "the first chunk is not JSON");
    at += kChunkHeaderBytes;
    if (!json_seen) {
      text_ = file_.text().substr(at, chunk.bytes.size());
      text_start_ = at;
    } else if (chunk.type == kBinChunk && !binary_) {
      binary_ = chunk.bytes;
    }
    json_seen = true;
    at += chunk.bytes.size();
  }
  if (!json_seen) fail_container(file_.name, kHeaderBytes, "no JSON chunk");
}

void Document::check_asset() const {
  const JsonValue asset = root().at("asset");
  const std::optional<JsonValue> minimum = asset.find("minVersion");
  const JsonValue version = minimum ? *minimum : asset.at("version");
  const std::string& text = version.string();
  const bool readable = minimum ? text == "2.0" : text.starts_with("2.");
  if (!readable) version.fail("version '" + printable(text) + "', only 2.0 is supported");
}

void Document::check_extensions() const {
  const std::optional<JsonValue> required = root().find("extensionsRequired");
  if (!required) return;
  for (std::size_t i = 0; i < required->size(); ++i) {
    const JsonValue name = (*required)[i];
    if (!is_supported(name.string()))
      name.fail("requires the extension " + printable(name.string()) + ", which is not supported");
  }
}

std::size_t Document::count(const char* list) const {
  const std::optional<JsonValue> items = root().find(list);
  return items ? items->size() : 0;
}

JsonValue Document::item(const char* list, std::size_t i) const { return root().at(list)[i]; }

JsonValue Document::item(const char* list, const JsonValue& reference) const {
  return item(list, reference.index(count(list), list));
}

void Document::warn(const JsonValue& place, const std::string& what) {
  if (warnings_.size() < kMostWarnings)
    warnings_.push_back(place.pointer().empty() ? what : place.pointer() + ": " + what);
  else
    ++suppressed_warnings_;
}

std::vector<std::string> Document::take_warnings() {
  if (suppressed_warnings_ > 0)
    warnings_.push_back("and " + std::to_string(suppressed_warnings_) + " more warnings");
  return std::move(warnings_);
}

void Document::charge(std::uint64_t count, std::size_t bytes_each, const JsonValue& place) {
  const std::uint64_t limit = kFreeBytes + kGrowth * input_bytes_;
  if (count > (limit - charged_) / bytes_each)
    throw Error(ErrorCode::resource,
                "the file asks for " + std::to_string(count) + " elements here, far more than " +
                    std::to_string(input_bytes_) + " bytes of input justify",
                file_.name, place.pointer());
  charged_ += count * bytes_each;
}

}  // namespace strahl::gltf
