// io/ply_header.h - the header of a PLY file: format, elements, their properties.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <strahl/io/file_bytes.h>

namespace strahl {

enum class PlyFormat { ascii, little_endian, big_endian };

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of a value in a binary file.
std::size_t size_of(PlyType type);
bool is_integer(PlyType type);

/// A column of an element: one value per row, or a counted list of values.
struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;    ///< of the value or of the list's items
  std::optional<PlyType> count_type;  ///< of the list's length; none: a single value
};

/// A table of `count` rows.
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::size_t header_line = 0;  ///< where it is declared, for messages
  std::vector<PlyProperty> properties;

  /// Column of the first property with one of these names; none if there is no such property.
  std::optional<std::size_t> column(std::initializer_list<std::string_view> names) const;
  /// Bytes of a row in a binary file if no property is a list.
  std::optional<std::size_t> fixed_row_bytes() const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t body_offset = 0;  ///< first byte behind the line end of end_header
  std::size_t body_line = 0;    ///< its line number, from 1

  /// The element of this name; null if there is none.
  const PlyElement* element(std::string_view name) const;
};

/// Parses the header. Lines may end with LF, CR LF or CR.
/// Throws Error{bad_input} naming the line: no PLY file, an unknown keyword, format or type, a
/// repeated name, a missing end_header.
PlyHeader parse_ply_header(const FileBytes& file);

}  // namespace strahl
