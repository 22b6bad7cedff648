// io/ply_source.h - the values of a PLY body in order, from text or from bytes of either order.
//
// Both sources offer the same calls, so that the reader of elements is written once:
//   real(type), integer(type, what)  the next value; floats of 32 bits are exact in the double
//   skip(type, n)                    passes over n values
//   end_row()                        behind the last value of each row
//   min_bytes(type)                  what one value takes at least, to check counts beforehand
//   where(), fail(reason), remaining()
// Invariants: reading never passes the end of the body; it is an Error naming the place.
// Thread safety: values, copied to remember a place; one thread at a time per source.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include <strahl/base/error.h>
#include <strahl/io/file_bytes.h>
#include <strahl/io/ply_header.h>
#include <strahl/io/text_cursor.h>

namespace strahl {

/// Body of `format ascii`.
class PlyText {
 public:
  PlyText(const FileBytes& file, const PlyHeader& header)
      : cursor_(file.text().substr(header.body_offset), file.name, {}, header.body_line) {}

  double real(PlyType type) {
    const std::string_view token = cursor_.token_of_any_line();
    if (type == PlyType::float32) return static_cast<double>(cursor_.to_number32(token, "value"));
    return cursor_.to_number(token, "value");
  }
  std::int64_t integer(PlyType, std::string_view what) {
    return cursor_.to_integer(cursor_.token_of_any_line(), what);
  }
  void skip(PlyType, std::uint64_t n) {
    for (std::uint64_t i = 0; i < n; ++i)
      if (cursor_.token_of_any_line().empty()) cursor_.fail("the file ends inside an element");
  }
  void end_row() {
    if (!cursor_.at_line_end()) cursor_.fail("more values than the header declares");
  }
  bool at_end() { return cursor_.at_end(); }

  static std::uint64_t min_bytes(PlyType) { return 2; }                // a digit and a blank
  std::uint64_t remaining() const { return cursor_.remaining() + 1; }  // the last blank may lack
  std::string where() const { return cursor_.where(); }
  [[noreturn]] void fail(const std::string& reason) const { cursor_.fail(reason); }

 private:
  TextCursor cursor_;
};

/// Body of the binary formats.
class PlyBinary {
 public:
  PlyBinary(const FileBytes& file, const PlyHeader& header)
      : bytes_(file.bytes),
        name_(&file.name),
        position_(header.body_offset),
        swap_((header.format == PlyFormat::little_endian) !=
              (std::endian::native == std::endian::little)) {}

  double real(PlyType type) {
    if (type == PlyType::float32) return static_cast<double>(load<float, std::uint32_t>());
    if (type == PlyType::float64) return load<double, std::uint64_t>();
    return static_cast<double>(integer(type, "value"));
  }
  std::int64_t integer(PlyType type, std::string_view what);
  void skip(PlyType type, std::uint64_t n) {
    require(n, size_of(type));
    position_ += n * size_of(type);
  }
  void end_row() {}
  bool at_end() const { return remaining() == 0; }

  static std::uint64_t min_bytes(PlyType type) { return size_of(type); }
  std::uint64_t remaining() const { return bytes_.size() - position_; }
  std::string where() const { return "byte " + std::to_string(position_); }
  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(ErrorCode::bad_input, reason, *name_, where());
  }

  /// The next byte, and whether values are stored as this machine stores them.
  const std::byte* data() const { return bytes_.data() + position_; }
  bool is_native() const { return !swap_; }

 private:
  void require(std::uint64_t n, std::uint64_t size) const {
    if (n > remaining() / size) fail("the file ends inside an element");
  }

  // T as stored: Bits is the unsigned integer of its size, whose bytes can be reversed.
  template <class T, class Bits>
  T load() {
    require(1, sizeof(T));
    Bits bits;
    std::memcpy(&bits, data(), sizeof bits);
    position_ += sizeof bits;
    return std::bit_cast<T>(swap_ ? reversed(bits) : bits);
  }
  template <class Bits>
  static Bits reversed(Bits bits) {
    Bits result = 0;
    for (std::size_t i = 0; i < sizeof bits; ++i)
      result = static_cast<Bits>((result << 7 << 1) | ((bits >> (8 * i)) & 0xFF));
    return result;
  }

  std::span<const std::byte> bytes_;
  const std::string* name_;
  std::size_t position_;
  bool swap_;
};

inline std::int64_t PlyBinary::integer(PlyType type, std::string_view what) {
  switch (type) {
    case PlyType::int8:
      return load<std::int8_t, std::uint8_t>();
    case PlyType::uint8:
      return load<std::uint8_t, std::uint8_t>();
    case PlyType::int16:
      return load<std::int16_t, std::uint16_t>();
    case PlyType::uint16:
      return load<std::uint16_t, std::uint16_t>();
    case PlyType::int32:
      return load<std::int32_t, std::uint32_t>();
    case PlyType::uint32:
      return load<std::uint32_t, std::uint32_t>();
    case PlyType::float32:
    case PlyType::float64:
      break;
  }
  fail(std::string(what) + " of a type that is no integer");
}

}  // namespace strahl
