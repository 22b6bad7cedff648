// io/gltf_buffers.h - the bytes behind the buffers and buffer views of a glTF file.
//
// A buffer is the BIN chunk, a base64 data URI or a file beside the glTF file, fetched when first
// used.
// Thread safety: one thread.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <strahl/io/gltf_document.h>

namespace strahl::gltf {

/// Bytes and what keeps them alive; a null owner: the caller of the reader does.
struct OwnedBytes {
  std::span<const std::byte> bytes;
  std::shared_ptr<const void> owner;
};

/// Part of a buffer. stride 0: elements are packed.
struct BufferView {
  OwnedBytes part;
  std::size_t stride = 0;
};

/// Decodes base64 (RFC 4648, padding required, nothing else allowed); nothing where malformed.
std::optional<std::vector<std::byte>> decode_base64(std::string_view text);

class Buffers {
 public:
  /// Checks that all buffer views lie within the stated length of their buffers.
  explicit Buffers(Document& document);

  /// The buffer view that `reference` gives the index of. Throws Error{bad_input}: no such view,
  /// or a buffer that is missing, unreadable or too short.
  BufferView view(const JsonValue& reference);

 private:
  const OwnedBytes& buffer(std::size_t i);
  OwnedBytes fetch(std::size_t i, const JsonValue& description);

  Document& document_;
  std::vector<std::optional<OwnedBytes>> buffers_;
};

}  // namespace strahl::gltf
