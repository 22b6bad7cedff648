// io/gltf_document.h - one glTF file being read: its JSON, its binary chunk, warnings, and an
// allowance for data that grows while it is read.
//
// Invariants: the version is 2.x and every required extension is one the reader supports.
// Thread safety: one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <strahl/io/file_bytes.h>
#include <strahl/io/gltf_json.h>

namespace strahl::gltf {

class Document {
 public:
  /// Splits a GLB, parses the JSON, checks version and extensions. Throws Error{bad_input}.
  explicit Document(const FileBytes& file);
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  const FileBytes& file() const { return file_; }
  /// The BIN chunk of a GLB; nothing where there is none.
  const std::optional<std::span<const std::byte>>& binary() const { return binary_; }

  JsonValue root() const { return {json_, file_.name}; }
  /// Length of a top-level array ("meshes"); 0 where absent.
  std::size_t count(const char* list) const;
  /// Element i < count(list) of a top-level array.
  JsonValue item(const char* list, std::size_t i) const;
  /// The element that `reference` gives the index of.
  JsonValue item(const char* list, const JsonValue& reference) const;

  /// Notes what was skipped or repaired, with its place. Only the first are kept.
  void warn(const JsonValue& place, const std::string& what);
  std::vector<std::string> take_warnings();

  /// Input read beside the file raises the allowance.
  void add_input(std::size_t bytes) { input_bytes_ += bytes; }
  /// Counts memory that is not a view of the input, before it is allocated (or work of that
  /// order), so that a small file cannot ask for much. Throws Error{resource}.
  void charge(std::uint64_t count, std::size_t bytes_each, const JsonValue& place);

 private:
  void split_container();
  void check_asset() const;
  void check_extensions() const;

  FileBytes file_;
  std::string_view text_;
  std::size_t text_start_ = 0;
  std::optional<std::span<const std::byte>> binary_;
  nlohmann::json json_;
  std::vector<std::string> warnings_;
  std::size_t suppressed_warnings_ = 0;
  std::size_t input_bytes_ = 0;
  std::uint64_t charged_ = 0;
};

}  // namespace strahl::gltf
