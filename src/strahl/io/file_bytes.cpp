#include <utility>

#include <strahl/io/file_bytes.h>
#include <strahl/io/mapped_file.h>

namespace strahl {

FileBytes map_file(const std::filesystem::path& path) {
  auto mapped = std::make_shared<const MappedFile>(path);
  const std::string_view text = mapped->bytes();
  FileBytes file;
  file.bytes = {reinterpret_cast<const std::byte*>(text.data()), text.size()};
  file.name = path.string();
  file.folder = path.has_parent_path() ? path.parent_path() : ".";
  file.owner = std::move(mapped);
  return file;
}

}  // namespace strahl
