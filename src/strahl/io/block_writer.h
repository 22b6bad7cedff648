// io/block_writer.h - text or bytes for an atomic file, written block by block, cancellable
// between.
//
// Thread safety: one object per thread.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include <strahl/base/build_context.h>
#include <strahl/io/atomic_file.h>

namespace strahl {

class BlockWriter {
 public:
  /// @param items how often item_done() will be called, for the progress of "writing"
  /// @param progress may be empty; asked before the file is created and after each block
  /// Throws Error{cancelled} when progress returns false, Error{resource} as AtomicFile does.
  BlockWriter(const std::filesystem::path& path, std::size_t items, const Progress& progress)
      : items_(items), progress_(progress), file_((ask(), path)) {}

  /// Throws as the constructor does.
  void put(std::string_view bytes) {
    buffer_ += bytes;
    if (buffer_.size() >= kBlock) flush();
  }
  void item_done() { ++done_; }

  /// Writes what is left; the file appears under its name.
  void commit() {
    flush();
    file_.commit();
  }

 private:
  static constexpr std::size_t kBlock = 1 << 16;

  void ask() const {
    const double fraction = items_ == 0 ? 1.0 : static_cast<double>(done_) / double(items_);
    if (progress_ && !progress_(fraction, "writing"))
      throw Error(ErrorCode::cancelled, "cancelled", "writing");
  }
  void flush() {
    file_.write(buffer_.data(), buffer_.size());
    buffer_.clear();
    ask();
  }

  std::size_t items_, done_ = 0;
  Progress progress_;
  AtomicFile file_;
  std::string buffer_;
};

}  // namespace strahl
