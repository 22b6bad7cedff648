// io/npy.cpp - writing NPY files and viewing mapped ones.
#include <cstring>

#include <strahl/base/error.h>
#include <strahl/io/atomic_file.h>
#include <strahl/io/npy.h>

namespace strahl {

void write_npy(const std::filesystem::path& path, const NpyArrayRef& array) {
  const std::string header = format_npy_header(array.dtype, array.shape);
  AtomicFile file(path);
  file.write(header.data(), header.size());
  file.write(array.data, static_cast<std::size_t>(array.bytes));
  file.commit();
}

NpyView::NpyView(const std::filesystem::path& path)
    : which_(path.string()), file_(path), header_(parse_npy_header(file_.bytes(), which_)) {
  // The map begins on a page, so the offset alone decides.
  if (header_.data_offset % npy_item_size(header_.dtype) == 0) return;
  aligned_copy_.resize(static_cast<std::size_t>(header_.data_bytes));
  if (!aligned_copy_.empty()) {
    std::memcpy(aligned_copy_.data(), file_.bytes().data() + header_.data_offset,
                aligned_copy_.size());
  }
}

const void* NpyView::data() const noexcept {
  if (!aligned_copy_.empty()) return aligned_copy_.data();
  return file_.bytes().data() + header_.data_offset;
}

std::string NpyView::description() const {
  return "dtype '" + std::string(npy_descr(header_.dtype)) + "', shape " +
         npy_shape_text(header_.shape);
}

void NpyView::require_dtype(NpyDtype expected) const {
  if (header_.dtype == expected) return;
  throw Error(
      ErrorCode::bad_input,
      "got " + description() + ", expected dtype '" + std::string(npy_descr(expected)) + "'",
      which_);
}

}  // namespace strahl
