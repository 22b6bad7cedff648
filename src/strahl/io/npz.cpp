// io/npz.cpp - NPZ through libzip: stored entries whose data stay where the caller has them.
#include <zip.h>

#include <strahl/base/error.h>
#include <strahl/io/npz.h>

namespace strahl {
namespace {

// 1 January 1980, the earliest date a zip can hold, as NumPy's own writer uses.
constexpr zip_uint16_t kDosDate = (1 << 5) | 1;
constexpr zip_uint16_t kDosTime = 0;

std::string message_of(int zip_code) {
  zip_error_t error;
  zip_error_init_with_code(&error, zip_code);
  std::string text = zip_error_strerror(&error);
  zip_error_fini(&error);
  return text;
}

}  // namespace

void NpzWriter::Discard::operator()(zip* archive) const { zip_discard(archive); }

NpzWriter::NpzWriter(const std::filesystem::path& path) : which_(path.string()), file_(path) {
  int code = 0;
  archive_.reset(zip_open(file_.path().c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code));
  if (!archive_) fail("cannot write: " + message_of(code));
}

NpzWriter::~NpzWriter() = default;

void NpzWriter::add(const std::string& name, const NpyArrayRef& array) {
  headers_.push_back(format_npy_header(array.dtype, array.shape));
  std::string& header = headers_.back();
  // libzip takes pointers to mutable bytes but only reads them when told not to free them.
  zip_buffer_fragment_t parts[] = {
      {reinterpret_cast<zip_uint8_t*>(header.data()), header.size()},
      {static_cast<zip_uint8_t*>(const_cast<void*>(array.data)), array.bytes}};
  const zip_uint64_t part_count = array.bytes > 0 ? 2 : 1;
  zip_source_t* source = zip_source_buffer_fragment(archive_.get(), parts, part_count, 0);
  if (source == nullptr) fail(zip_strerror(archive_.get()));
  const zip_int64_t added =
      zip_file_add(archive_.get(), (name + ".npy").c_str(), source, ZIP_FL_ENC_UTF_8);
  if (added < 0) {
    zip_source_free(source);
    throw Error(ErrorCode::usage, "array '" + name + "': " + zip_strerror(archive_.get()), which_);
  }
  const auto index = static_cast<zip_uint64_t>(added);
  if (zip_set_file_compression(archive_.get(), index, ZIP_CM_STORE, 0) != 0 ||
      zip_file_set_dostime(archive_.get(), index, kDosTime, kDosDate, 0) != 0) {
    fail(zip_strerror(archive_.get()));
  }
}

void NpzWriter::close(const Progress& progress) {
  if (headers_.empty()) throw Error(ErrorCode::usage, "no arrays to write", which_);
  if (progress) {
    // libzip asks between blocks; a callback of C must not let an exception pass.
    const auto is_cancelled = [](zip_t*, void* asked) noexcept -> int {
      return (*static_cast<const Progress*>(asked))(1.0, "writing") ? 0 : 1;
    };
    void* asked = const_cast<Progress*>(&progress);
    zip_register_cancel_callback_with_state(archive_.get(), is_cancelled, nullptr, asked);
  }
  const bool failed = zip_close(archive_.get()) != 0;
  if (failed && zip_error_code_zip(zip_get_error(archive_.get())) == ZIP_ER_CANCELLED)
    throw Error(ErrorCode::cancelled, "cancelled", which_);
  if (failed) fail("cannot write: " + std::string(zip_strerror(archive_.get())));
  static_cast<void>(archive_.release());  // zip_close has freed it
  file_.commit();
}

void NpzWriter::fail(const std::string& reason) const {
  throw Error(ErrorCode::resource, reason, which_);
}

}  // namespace strahl
