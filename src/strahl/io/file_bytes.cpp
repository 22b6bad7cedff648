#include <fcntl.h>
#include <strahl/io/file_bytes.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <strahl/base/error.h>

namespace strahl {
namespace {

struct Descriptor {
  int fd;
  explicit Descriptor(int f) : fd(f) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

[[noreturn]] void fail(const std::string& name) {
  throw Error(ErrorCode::bad_input, std::strerror(errno), name);
}

}  // namespace

FileBytes map_file(const std::filesystem::path& path) {
  FileBytes file{{}, path.string(), path.parent_path(), nullptr};
  if (file.folder.empty()) file.folder = ".";
  const Descriptor in(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat info {};
  if (in.fd < 0 || ::fstat(in.fd, &info) != 0) fail(file.name);
  if (!S_ISREG(info.st_mode)) throw Error(ErrorCode::bad_input, "not a regular file", file.name);
  const auto size = static_cast<std::size_t>(info.st_size);
  if (size == 0) return file;
  void* map = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, in.fd, 0);
  if (map == MAP_FAILED) fail(file.name);
  file.owner = std::shared_ptr<const void>(
      map, [size](const void* p) { ::munmap(const_cast<void*>(p), size); });
  file.bytes = {static_cast<const std::byte*>(map), size};
  return file;
}

}  // namespace strahl
