// io/npy_header.h - the header of an NPY file: element type, order and shape.
//
// Format: "\x93NUMPY", major and minor version, header length (2 bytes little-endian in version 1,
// 4 in versions 2 and 3), then a Python dictionary literal with exactly the keys descr,
// fortran_order and shape, padded with blanks to a multiple of 64 bytes in all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace strahl {

/// Element types, all little-endian.
enum class NpyDtype { f4, f8, u4, i8, i1, b1 };

/// Bytes of one element.
std::size_t npy_item_size(NpyDtype dtype);

/// As NumPy writes it: "<f4", "|i1", ...
std::string_view npy_descr(NpyDtype dtype);

/// As Python prints a tuple: (), (3,), (3, 6).
std::string npy_shape_text(const std::vector<std::uint64_t>& shape);

struct NpyHeader {
  NpyDtype dtype = NpyDtype::f8;
  std::vector<std::uint64_t> shape;  ///< C order: the last index runs fastest
  std::size_t data_offset = 0;       ///< bytes from the start of the file
  std::uint64_t data_bytes = 0;      ///< item size times all of shape
};

/// The complete version 1 header of an array, padded to a multiple of 64 bytes.
std::string format_npy_header(NpyDtype dtype, const std::vector<std::uint64_t>& shape);

/// Reads the header at the beginning of `file` (the whole file) and checks that exactly the data it
/// promises follow. Versions 1 to 3, little-endian, C order, at most 32 dimensions.
/// @param which the file's name, for messages
/// Throws Error{bad_input} saying what was got. Allocates nothing in proportion to numbers in the
/// file.
NpyHeader parse_npy_header(std::string_view file, const std::string& which);

}  // namespace strahl
