// io/npz.h - several named arrays in one uncompressed NPZ file (a zip of NPY files).
//
// Invariants: equal arrays in equal order give byte-identical files (fixed time stamps); sizes
// above 4 GiB use zip64; arrays are never copied. Thread safety: one object per thread.
#pragma once

#include <deque>
#include <filesystem>
#include <memory>
#include <string>

#include <strahl/base/build_context.h>
#include <strahl/io/atomic_file.h>
#include <strahl/io/npy.h>

struct zip;

namespace strahl {

class NpzWriter {
 public:
  /// Throws Error{resource} when the folder cannot be written to.
  explicit NpzWriter(const std::filesystem::path& path);
  ~NpzWriter();
  NpzWriter(const NpzWriter&) = delete;
  NpzWriter& operator=(const NpzWriter&) = delete;

  /// Adds `array` under `name` (without ".npy"). The values are read by close() and must live and
  /// stay unchanged until then. Throws Error{usage} for a name given twice.
  void add(const std::string& name, const NpyArrayRef& array);

  /// Writes everything; the file appears under its name now. Without it nothing is written.
  /// @param progress asked again and again while bytes are copied, if not empty
  /// Throws Error{usage} when nothing was added, Error{cancelled} when progress returns false.
  /// Throws Error{resource}; whatever was under the name before is then untouched.
  void close(const Progress& progress = {});

 private:
  struct Discard {
    void operator()(zip* archive) const;
  };

  [[noreturn]] void fail(const std::string& reason) const;

  std::string which_;
  AtomicFile file_;
  std::deque<std::string> headers_;  ///< a deque, since the archive keeps pointers to them
  std::unique_ptr<zip, Discard> archive_;
};

}  // namespace strahl
