// io/atomic_file.cpp - temporary name, exclusive creation, rename.
#include <cerrno>
#include <cstdint>
#include <random>
#include <string>
#include <system_error>

#include <strahl/base/error.h>
#include <strahl/base/hash.h>
#include <strahl/io/atomic_file.h>

namespace strahl {
namespace {

namespace fs = std::filesystem;

/// Short and independent of the target's name, so it is valid wherever the target's name is.
std::string temporary_name() {
  std::random_device random;
  const std::uint64_t high = random();
  return ".strahl-" + to_hex((high << 32) | random()) + ".part";
}

bool is_written_in_place(const fs::file_status& status) {
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) : target_(target) {
  std::error_code error;
  if (fs::is_symlink(fs::symlink_status(target, error))) {
    const fs::path followed = fs::weakly_canonical(target, error);
    if (!error) target_ = followed;
  }
  const fs::file_status status = fs::status(target_, error);
  if (fs::is_directory(status)) {
    throw Error(ErrorCode::resource, "cannot write: it is a folder", target.string());
  }
  if (is_written_in_place(status)) {
    temporary_ = target_;
    stream_ = std::fopen(target_.c_str(), "wb");
  } else {
    create_beside();
  }
  if (stream_ == nullptr) fail("cannot write");
}

AtomicFile::~AtomicFile() {
  if (stream_ != nullptr) std::fclose(stream_);
  std::error_code ignored;  // nothing more can be done about a file that cannot be removed
  if (temporary_ != target_) fs::remove(temporary_, ignored);
}

void AtomicFile::create_beside() {
  constexpr int kAttempts = 16;  // one is enough unless 64 random bits collide
  for (int attempt = 0; attempt < kAttempts && stream_ == nullptr; ++attempt) {
    temporary_ = target_.parent_path() / temporary_name();
    errno = 0;
    stream_ = std::fopen(temporary_.c_str(), "wbx");
    if (stream_ == nullptr && errno != EEXIST) break;
  }
  // Not ours: the destructor of a half-made object does not run, but fail() must not name it.
  if (stream_ == nullptr) temporary_ = target_;
}

void AtomicFile::write(const void* data, std::size_t size) {
  if (size > 0 && std::fwrite(data, 1, size, stream_) != size) fail("cannot write");
}

void AtomicFile::commit() {
  const bool failed_before = std::ferror(stream_) != 0;
  errno = 0;
  const bool failed_to_close = std::fclose(stream_) != 0;
  stream_ = nullptr;
  if (failed_before || failed_to_close) fail("cannot write");
  if (temporary_ == target_) return;
  std::error_code error;
  const fs::file_status status = fs::status(target_, error);
  if (fs::is_regular_file(status)) fs::permissions(temporary_, status.permissions(), error);
  fs::rename(temporary_, target_, error);
  if (error) {
    throw Error(ErrorCode::resource, "cannot rename the finished file: " + error.message(),
                target_.string());
  }
  temporary_ = target_;
}

void AtomicFile::fail(const char* action) const {
  const std::string cause = errno != 0 ? ": " + std::generic_category().message(errno) : "";
  throw Error(ErrorCode::resource, action + cause, target_.string());
}

void write_text_file(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text.data(), text.size());
  file.commit();
}

}  // namespace strahl
