// io/file_bytes.h - the bytes of an input file, memory-mapped, with the name errors cite.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace strahl {

/// Bytes to be parsed. Readers take this, so tests and fuzzers can pass memory.
struct FileBytes {
  std::span<const std::byte> bytes;
  std::string name;                   ///< cited in errors
  std::filesystem::path folder;       ///< where sibling files are looked up; empty: none allowed
  std::shared_ptr<const void> owner;  ///< keeps bytes alive; readers may keep it for zero copy

  std::string_view text() const {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
};

/// Maps a regular file read-only. Throws Error{bad_input} naming the path and the system's reason.
FileBytes map_file(const std::filesystem::path& path);

}  // namespace strahl
