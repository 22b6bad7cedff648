// io/npy_header.cpp - printing NPY headers, and a strict reader of their dictionary literal.
#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

#include <strahl/base/error.h>
#include <strahl/io/npy_header.h>

namespace strahl {
namespace {

struct DtypeInfo {
  NpyDtype dtype;
  std::string_view descr;
  std::size_t size;
};

constexpr std::array<DtypeInfo, 6> kDtypes{{{NpyDtype::f4, "<f4", 4},
                                            {NpyDtype::f8, "<f8", 8},
                                            {NpyDtype::u4, "<u4", 4},
                                            {NpyDtype::i8, "<i8", 8},
                                            {NpyDtype::i1, "|i1", 1},
                                            {NpyDtype::b1, "|b1", 1}}};

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kAlignment = 64;
constexpr std::size_t kMaxDimensions = 32;  // NumPy's own limit

const DtypeInfo& info_of(NpyDtype dtype) {
  return *std::find_if(kDtypes.begin(), kDtypes.end(),
                       [=](const DtypeInfo& info) { return info.dtype == dtype; });
}

/// Text from the file, fit to be shown: printable and not long.
std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string result(text.substr(0, kLongest));
  for (char& c : result) c = c < ' ' || c > '~' ? '?' : c;
  return "'" + result + (text.size() > kLongest ? "...'" : "'");
}

/// Walks over the dictionary literal, one token at a time.
class LiteralReader {
 public:
  LiteralReader(std::string_view text, std::size_t offset, const std::string& which)
      : text_(text), offset_(offset), which_(which) {}

  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(ErrorCode::bad_input, reason, which_, "byte " + std::to_string(offset_ + at_));
  }

  bool accept(char c) {
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  void expect(char c) {
    if (!accept(c)) fail(std::string("bad NPY header: expected '") + c + "'");
  }

  bool at_end() {
    skip_blanks();
    return at_ == text_.size();
  }

  /// A string in single or double quotes; escapes do not occur in what NumPy writes.
  std::string_view string() {
    skip_blanks();
    const char quote = at_ < text_.size() ? text_[at_] : '\0';
    if (quote != '\'' && quote != '"') fail("bad NPY header: expected a string");
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) fail("bad NPY header: string without an end");
    const std::string_view value = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return value;
  }

  bool boolean() {
    skip_blanks();
    for (const auto& [word, value] : {std::pair<std::string_view, bool>("True", true),
                                      std::pair<std::string_view, bool>("False", false)}) {
      if (text_.substr(at_, word.size()) != word) continue;
      at_ += word.size();
      return value;
    }
    fail("bad NPY header: expected True or False");
  }

  std::uint64_t whole_number() {
    skip_blanks();
    std::uint64_t value = 0;
    const char* end = text_.data() + text_.size();
    const std::from_chars_result result = std::from_chars(text_.data() + at_, end, value);
    if (result.ec == std::errc::result_out_of_range) fail("bad NPY header: dimension too large");
    if (result.ec != std::errc()) fail("bad NPY header: expected a dimension, a whole number >= 0");
    at_ = static_cast<std::size_t>(result.ptr - text_.data());
    if (at_ < text_.size() && text_[at_] == 'L') ++at_;  // Python 2 wrote long integers so
    return value;
  }

  /// A tuple of dimensions; as in Python, one element needs a trailing comma.
  std::vector<std::uint64_t> tuple() {
    std::vector<std::uint64_t> shape;
    expect('(');
    bool ended_by_comma = true;
    while (!accept(')')) {
      if (!ended_by_comma) fail("bad NPY header: expected ',' or ')' in the shape");
      if (shape.size() == kMaxDimensions) fail("NPY array of more than 32 dimensions");
      shape.push_back(whole_number());
      ended_by_comma = accept(',');
    }
    if (shape.size() == 1 && !ended_by_comma) fail("bad NPY header: the shape is not a tuple");
    return shape;
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }

  std::string_view text_;
  std::size_t offset_;
  const std::string& which_;
  std::size_t at_ = 0;
};

NpyDtype read_dtype(LiteralReader& reader) {
  if (reader.accept('[')) reader.fail("NPY array of records, expected plain numbers");
  const std::string_view descr = reader.string();
  for (const DtypeInfo& info : kDtypes) {
    // Byte order means nothing for single bytes.
    const bool is_same_byte = info.size == 1 && descr.size() == 3 &&
                              descr.substr(1) == info.descr.substr(1) &&
                              (descr[0] == '<' || descr[0] == '>');
    if (descr == info.descr || is_same_byte) return info.dtype;
  }
  const std::string order = descr.substr(0, 1) == ">" ? " (big-endian)" : "";
  reader.fail("NPY dtype " + shown(descr) + order +
              ", expected one of '<f4', '<f8', '<u4', '<i8', '|i1', '|b1'");
}

/// What the dictionary says; absent keys stay empty.
struct Fields {
  std::optional<NpyDtype> dtype;
  std::optional<bool> is_fortran;
  std::optional<std::vector<std::uint64_t>> shape;
};

void read_field(LiteralReader& reader, Fields& fields) {
  const std::string_view key = reader.string();
  reader.expect(':');
  if (key == "descr" && !fields.dtype) {
    fields.dtype = read_dtype(reader);
  } else if (key == "fortran_order" && !fields.is_fortran) {
    fields.is_fortran = reader.boolean();
  } else if (key == "shape" && !fields.shape) {
    fields.shape = reader.tuple();
  } else {
    reader.fail("bad NPY header: key " + shown(key) + " is unknown or comes twice");
  }
}

Fields read_dictionary(LiteralReader& reader) {
  Fields fields;
  reader.expect('{');
  bool ended_by_comma = true;
  while (!reader.accept('}')) {
    if (!ended_by_comma) reader.fail("bad NPY header: expected ',' or '}'");
    read_field(reader, fields);
    ended_by_comma = reader.accept(',');
  }
  if (!reader.at_end()) reader.fail("bad NPY header: text after the dictionary");
  if (!fields.dtype) reader.fail("bad NPY header: no descr");
  if (!fields.is_fortran) reader.fail("bad NPY header: no fortran_order");
  if (!fields.shape) reader.fail("bad NPY header: no shape");
  return fields;
}

/// Product of item size and dimensions; empty on overflow.
std::optional<std::uint64_t> byte_count(std::size_t item_size,
                                        const std::vector<std::uint64_t>& shape) {
  if (std::find(shape.begin(), shape.end(), 0u) != shape.end()) return 0;
  std::uint64_t bytes = item_size;
  for (const std::uint64_t extent : shape) {
    if (extent > std::numeric_limits<std::uint64_t>::max() / bytes) return std::nullopt;
    bytes *= extent;
  }
  return bytes;
}

/// The literal inside the file and where it begins.
struct Literal {
  std::string_view text;
  std::size_t offset;
};

Literal find_literal(std::string_view file, const std::string& which) {
  const auto refuse = [&](const std::string& reason) {
    throw Error(ErrorCode::bad_input, reason, which);
  };
  const auto byte = [&](std::size_t i) { return std::size_t{static_cast<unsigned char>(file[i])}; };
  if (file.size() < 10 || file.substr(0, kMagic.size()) != kMagic) {
    refuse("not an NPY file: " + std::to_string(file.size()) + " bytes without its signature");
  }
  const std::size_t major = byte(6);
  if (major < 1 || major > 3 || byte(7) != 0) {
    refuse("NPY version " + std::to_string(major) + "." + std::to_string(byte(7)) +
           ", expected 1.0, 2.0 or 3.0");
  }
  const std::size_t offset = major == 1 ? 10 : 12;
  if (file.size() < offset) refuse("NPY header cut off");
  std::size_t length = byte(8) | byte(9) << 8;
  if (major > 1) length |= byte(10) << 16 | byte(11) << 24;
  if (length > file.size() - offset) {
    refuse("NPY header of " + std::to_string(length) + " bytes in a file of " +
           std::to_string(file.size()));
  }
  return {file.substr(offset, length), offset};
}

}  // namespace

std::size_t npy_item_size(NpyDtype dtype) { return info_of(dtype).size; }

std::string_view npy_descr(NpyDtype dtype) { return info_of(dtype).descr; }

std::string npy_shape_text(const std::vector<std::uint64_t>& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (i > 0) text += ", ";
    text += std::to_string(shape[i]);
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

std::string format_npy_header(NpyDtype dtype, const std::vector<std::uint64_t>& shape) {
  std::string literal = "{'descr': '" + std::string(npy_descr(dtype)) +
                        "', 'fortran_order': False, 'shape': " + npy_shape_text(shape) + ", }";
  constexpr std::size_t kPrefix = 10;  // magic, version, length
  const std::size_t unpadded = kPrefix + literal.size() + 1;
  literal.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
  literal += '\n';
  std::string header(kMagic);
  header += {'\x01', '\x00', static_cast<char>(literal.size() & 0xFF),
             static_cast<char>(literal.size() >> 8)};
  return header + literal;
}

NpyHeader parse_npy_header(std::string_view file, const std::string& which) {
  const Literal literal = find_literal(file, which);
  LiteralReader reader(literal.text, literal.offset, which);
  Fields fields = read_dictionary(reader);
  const auto refuse = [&](const std::string& reason) {
    throw Error(ErrorCode::bad_input, reason, which);
  };
  const std::string shape = npy_shape_text(*fields.shape);
  if (*fields.is_fortran) refuse("NPY array of shape " + shape + " in Fortran order, expected C");
  const std::size_t data_offset = literal.offset + literal.text.size();
  const std::optional<std::uint64_t> bytes =
      byte_count(npy_item_size(*fields.dtype), *fields.shape);
  const std::size_t present = file.size() - data_offset;
  if (!bytes || *bytes != present) {
    refuse("NPY array of dtype '" + std::string(npy_descr(*fields.dtype)) + "' and shape " + shape +
           " needs " + (bytes ? std::to_string(*bytes) : "more than 2^64") +
           " bytes of data, got " + std::to_string(present));
  }
  return {*fields.dtype, std::move(*fields.shape), data_offset, *bytes};
}

}  // namespace strahl
