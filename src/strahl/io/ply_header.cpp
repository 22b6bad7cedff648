// io/ply_header.cpp - parser of PLY headers.
#include <algorithm>
#include <array>
#include <utility>

#include <strahl/io/ply_header.h>
#include <strahl/io/text_cursor.h>

namespace strahl {
namespace {

// Names are compared with all before them, so their number is limited.
constexpr std::size_t kMaxNames = 4096;

// Both generations of names are in use.
PlyType parse_type(TextCursor& cursor) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames{{
      {"char", PlyType::int8},
      {"int8", PlyType::int8},
      {"uchar", PlyType::uint8},
      {"uint8", PlyType::uint8},
      {"short", PlyType::int16},
      {"int16", PlyType::int16},
      {"ushort", PlyType::uint16},
      {"uint16", PlyType::uint16},
      {"int", PlyType::int32},
      {"int32", PlyType::int32},
      {"uint", PlyType::uint32},
      {"uint32", PlyType::uint32},
      {"float", PlyType::float32},
      {"float32", PlyType::float32},
      {"double", PlyType::float64},
      {"float64", PlyType::float64},
  }};
  const std::string_view token = cursor.token();
  for (const auto& [name, type] : kNames)
    if (token == name) return type;
  cursor.fail("unknown property type " + quote(token));
}

PlyFormat parse_format(TextCursor& cursor) {
  const std::string_view format = cursor.token(), version = cursor.token();
  if (version != "1.0") cursor.fail("unknown PLY version " + quote(version));
  if (format == "ascii") return PlyFormat::ascii;
  if (format == "binary_little_endian") return PlyFormat::little_endian;
  if (format == "binary_big_endian") return PlyFormat::big_endian;
  cursor.fail("unknown PLY format " + quote(format));
}

PlyElement parse_element(TextCursor& cursor, const PlyHeader& header) {
  if (header.elements.size() == kMaxNames) cursor.fail("more than 4096 elements");
  PlyElement element;
  element.name = cursor.token();
  if (header.element(element.name)) cursor.fail("element " + quote(element.name) + " repeated");
  const std::int64_t count = cursor.integer("element count");
  if (count < 0) cursor.fail("negative element count " + std::to_string(count));
  element.count = static_cast<std::uint64_t>(count);
  element.header_line = cursor.line();
  return element;
}

void parse_property(TextCursor& cursor, PlyElement& element) {
  if (element.properties.size() == kMaxNames) cursor.fail("more than 4096 properties");
  PlyProperty property;
  TextCursor look_ahead = cursor;
  if (look_ahead.token() == "list") {
    cursor = look_ahead;
    property.count_type = parse_type(cursor);
    if (!is_integer(*property.count_type)) cursor.fail("list count of a type that is no integer");
  }
  property.type = parse_type(cursor);
  property.name = cursor.token();
  if (property.name.empty()) cursor.fail("property without a name");
  if (element.column({property.name}))
    cursor.fail("property " + quote(property.name) + " repeated");
  element.properties.push_back(std::move(property));
}

// A binary body may begin with a byte that looks like a line end, so exactly one line end is
// taken: that of the file's first line where a lone CR would be ambiguous.
std::size_t behind_line_end(std::string_view text, std::size_t at) {
  const std::size_t first = std::min(text.find_first_of("\r\n"), text.size());
  const bool lone_cr = text.substr(first, 1) == "\r" && text.substr(first, 2) != "\r\n";
  const bool pair = !lone_cr && text.substr(at, 2) == "\r\n";
  return std::min(at + (pair ? 2 : 1), text.size());
}

}  // namespace

std::size_t size_of(PlyType type) {
  static constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

bool is_integer(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

std::optional<std::size_t> PlyElement::column(std::initializer_list<std::string_view> names) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (std::find(names.begin(), names.end(), properties[i].name) != names.end()) return i;
  return std::nullopt;
}

std::optional<std::size_t> PlyElement::fixed_row_bytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& property : properties) {
    if (property.count_type) return std::nullopt;
    bytes += size_of(property.type);
  }
  return bytes;
}

const PlyElement* PlyHeader::element(std::string_view name) const {
  for (const PlyElement& e : elements)
    if (e.name == name) return &e;
  return nullptr;
}

PlyHeader parse_ply_header(const FileBytes& file) {
  TextCursor cursor(file.text(), file.name);
  if (cursor.token() != "ply" || !cursor.at_line_end()) cursor.fail("no PLY file: no line 'ply'");
  PlyHeader header;
  bool has_format = false;
  while (cursor.next_line()) {
    if (cursor.at_line_end()) continue;
    const std::string_view keyword = cursor.token();
    if (keyword == "comment" || keyword == "obj_info") continue;
    if (keyword == "format") {
      header.format = parse_format(cursor);
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(parse_element(cursor, header));
    } else if (keyword == "property") {
      if (header.elements.empty()) cursor.fail("property before any element");
      parse_property(cursor, header.elements.back());
    } else if (keyword != "end_header") {
      cursor.fail("unknown header keyword " + quote(keyword));
    }
    if (!cursor.at_line_end()) cursor.fail("unexpected " + quote(cursor.token()));
    if (keyword != "end_header") continue;
    if (!has_format) cursor.fail("header without a format line");
    header.body_offset = behind_line_end(file.text(), cursor.offset());
    header.body_line = cursor.line() + 1;
    return header;
  }
  cursor.fail("header without end_header");
}

}  // namespace strahl
