// io/npy.h - arrays in NumPy's NPY format: writing from memory, reading through a memory map.
//
// Thread safety: a NpyView may be read from any number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <strahl/io/mapped_file.h>
#include <strahl/io/npy_header.h>

namespace strahl {

/// The dtype of float, double, std::uint32_t, std::int64_t, std::int8_t, and bool (also as
/// std::uint8_t holding 0 or 1, since std::vector<bool> has no elements to point at).
template <class T>
consteval NpyDtype npy_dtype_of() {
  if constexpr (std::is_same_v<T, float>) return NpyDtype::f4;
  if constexpr (std::is_same_v<T, double>) return NpyDtype::f8;
  if constexpr (std::is_same_v<T, std::uint32_t>) return NpyDtype::u4;
  if constexpr (std::is_same_v<T, std::int64_t>) return NpyDtype::i8;
  if constexpr (std::is_same_v<T, std::int8_t>) return NpyDtype::i1;
  if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::uint8_t>) return NpyDtype::b1;
}

/// An array somewhere in memory, in C order; not owned.
struct NpyArrayRef {
  NpyDtype dtype = NpyDtype::f8;
  std::vector<std::uint64_t> shape;
  const void* data = nullptr;
  std::uint64_t bytes = 0;
};

/// The values as an array of shape (n), or with `columns` > 0 of shape (n / columns, columns).
/// Requires: columns divides the number of values; the values outlive the reference.
template <class T>
NpyArrayRef npy_array(std::span<const T> values, std::uint64_t columns = 0) {
  std::vector<std::uint64_t> shape{values.size()};
  if (columns > 0) shape = {values.size() / columns, columns};
  return {npy_dtype_of<T>(), std::move(shape), values.data(), values.size_bytes()};
}

template <class T>
NpyArrayRef npy_array(const std::vector<T>& values, std::uint64_t columns = 0) {
  return npy_array(std::span<const T>(values), columns);
}

/// Writes one array; the file appears when complete. Throws Error{resource}.
void write_npy(const std::filesystem::path& path, const NpyArrayRef& array);

/// An NPY file mapped read-only. Opening costs the header only; data are paged in when touched.
/// (Data at an odd address, which NumPy never writes, are copied.)
class NpyView {
 public:
  /// Throws Error{bad_input} for anything but a complete little-endian C-order array of one of the
  /// dtypes above, saying what was got.
  explicit NpyView(const std::filesystem::path& path);

  NpyDtype dtype() const noexcept { return header_.dtype; }
  const std::vector<std::uint64_t>& shape() const noexcept { return header_.shape; }

  /// Aligned for the dtype.
  const void* data() const noexcept;
  std::uint64_t bytes() const noexcept { return header_.data_bytes; }

  /// The file's name, for messages.
  const std::string& which() const noexcept { return which_; }

  /// "dtype '<f4', shape (3, 5)", for messages that say what was got.
  std::string description() const;

  /// All elements in C order. Throws Error{bad_input} when the dtype is another one; bool is read
  /// as std::uint8_t, since a file may hold other bytes than 0 and 1.
  template <class T>
  requires(!std::is_same_v<T, bool>) std::span<const T> as()
  const {
    require_dtype(npy_dtype_of<T>());
    return {static_cast<const T*>(data()), static_cast<std::size_t>(bytes() / sizeof(T))};
  }

 private:
  void require_dtype(NpyDtype expected) const;

  std::string which_;
  MappedFile file_;
  NpyHeader header_;
  std::vector<std::byte> aligned_copy_;
};

}  // namespace strahl
