// io/gltf_json.h - JSON values that know their place in the file, so that misuse is an error
// citing it.
//
// Invariants: nesting of a parsed document is at most kMaxJsonDepth, so nothing recurses deeply.
// Thread safety: values over an immutable document.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace strahl::gltf {

/// Far above what glTF needs (about 10), far below what would exhaust a stack.
inline constexpr int kMaxJsonDepth = 256;

/// Parses a whole document. `file` and `first_byte` (of text in the file) are for errors.
/// Throws Error{bad_input} citing the byte.
nlohmann::json parse_json(std::string_view text, const std::string& file, std::size_t first_byte);

/// Text from a file made fit for a message: shortened, control characters replaced.
std::string printable(std::string_view text);

/// A value and its JSON pointer. Refers to the document and the file name it was made from.
/// All accessors throw Error{bad_input} citing the pointer where type or range do not fit.
class JsonValue {
 public:
  JsonValue(const nlohmann::json& json, const std::string& file, std::string pointer = {})
      : json_(&json), file_(&file), pointer_(std::move(pointer)) {}

  /// Reports this place.
  [[noreturn]] void fail(const std::string& reason) const;
  const std::string& pointer() const { return pointer_; }

  /// Member of an object; nothing where absent.
  std::optional<JsonValue> find(const char* key) const;
  JsonValue at(const char* key) const;
  /// Fails where the object has any other member.
  void allow_only(std::initializer_list<std::string_view> members) const;

  /// Elements of an array; i < size().
  std::size_t size() const;
  JsonValue operator[](std::size_t i) const;

  bool is_string() const { return json_->is_string(); }
  const std::string& string() const;
  bool boolean() const;
  double number() const;
  /// A number >= 0 without fraction that fits; 3.0 counts as 3.
  std::uint64_t integer() const;
  /// integer() < count, the number of `what` there are.
  std::uint32_t index(std::size_t count, const char* what) const;
  /// An array of exactly N numbers.
  template <std::size_t N>
  std::array<double, N> numbers() const {
    if (size() != N) fail("must hold " + std::to_string(N) + " numbers");
    std::array<double, N> values{};
    for (std::size_t i = 0; i < N; ++i) values[i] = (*this)[i].number();
    return values;
  }

 private:
  [[noreturn]] void fail_type(const char* wanted) const;

  const nlohmann::json* json_;
  const std::string* file_;
  std::string pointer_;
};

/// Optional members with the defaults of the specification.
std::uint64_t integer_or(const JsonValue& object, const char* key, std::uint64_t otherwise);
std::string string_or(const JsonValue& object, const char* key, const std::string& otherwise);
bool boolean_or(const JsonValue& object, const char* key, bool otherwise);

}  // namespace strahl::gltf
