// io/mapped_file.h - a whole file as read-only memory, without reading it.
//
// Invariants: the file must not be shortened by others while it is mapped (the system would end the
// process on access).
// Thread safety: const access from any number of threads.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace strahl {

class MappedFile {
 public:
  /// Throws Error{bad_input} when `path` is not a regular file that can be read.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;

  /// All bytes; page-aligned; empty for an empty file.
  std::string_view bytes() const noexcept { return {data_, size_}; }

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace strahl
