// io/atomic_file.h - an output file that appears under its name only when it is complete.
//
// Written beside its target under a temporary name, renamed by commit(), removed by the destructor:
// a partly written output never replaces a good one, and an exception leaves nothing behind.
// Thread safety: one object per thread.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string_view>

namespace strahl {

class AtomicFile {
 public:
  /// Creates an empty temporary file in the folder of `target`; a symbolic link is followed.
  /// A target that is neither a file nor a folder (/dev/null, a pipe) is opened and written itself.
  /// Throws Error{resource} when that is impossible.
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write, for libraries that open files themselves.
  const std::filesystem::path& path() const noexcept { return temporary_; }

  /// The same file, open for binary writing; owned by this object.
  std::FILE* stream() const noexcept { return stream_; }

  /// Appends to stream(). Throws Error{resource}, naming the target.
  void write(const void* data, std::size_t size);

  /// Closes and renames; existing permissions of the target are kept. To be called once.
  /// Throws Error{resource} when anything could not be written; the target is then as before.
  void commit();

 private:
  [[noreturn]] void fail(const char* action) const;
  void create_beside();

  std::filesystem::path target_;
  std::filesystem::path temporary_;  ///< equals target_ when written in place
  std::FILE* stream_ = nullptr;
};

/// Writes a whole file at once. Throws Error{resource}.
void write_text_file(const std::filesystem::path& path, std::string_view text);

}  // namespace strahl
