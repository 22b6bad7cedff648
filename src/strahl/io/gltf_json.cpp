#include <algorithm>

#include <strahl/base/error.h>
#include <strahl/io/gltf_json.h>

namespace strahl::gltf {
namespace {

using nlohmann::json;

// The parser's message without its own prefix and without raw bytes of the file.
std::string parser_reason(std::string_view message) {
  const std::size_t place = message.find("column ");
  const std::size_t colon = message.find(": ", place == std::string_view::npos ? 0 : place);
  if (colon != std::string_view::npos) message.remove_prefix(colon + 2);
  return printable(message.substr(0, message.find("; last read")));
}

// Brackets outside strings, before the parser sees them: its own callback would do the same in time
// quadratic in the length of an array.
void check_depth(std::string_view text, const std::string& file, std::size_t first_byte) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string && c == '\\') ++i;
    if (c == '"') in_string = !in_string;
    if (in_string) continue;
    if (c == '}' || c == ']') --depth;
    if ((c == '{' || c == '[') && ++depth > kMaxJsonDepth)
      throw Error(ErrorCode::bad_input,
                  "JSON nested deeper than " + std::to_string(kMaxJsonDepth) + " levels", file,
                  "byte " + std::to_string(first_byte + i));
  }
}

}  // namespace

std::string printable(std::string_view text) {
  constexpr std::size_t kLongest = 120;
  std::string result;
  for (const char c : text.substr(0, kLongest))
    result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  // Do not leave half a UTF-8 sequence at the cut.
  if (text.size() > kLongest) {
    while (!result.empty() && (result.back() & 0x80) != 0) result.pop_back();
    result += "...";
  }
  return result;
}

json parse_json(std::string_view text, const std::string& file, std::size_t first_byte) {
  check_depth(text, file, first_byte);
  try {
    return json::parse(text.begin(), text.end());
  } catch (const json::parse_error& e) {
    throw Error(ErrorCode::bad_input, "not JSON: " + parser_reason(e.what()), file,
                "byte " + std::to_string(first_byte + e.byte));
  } catch (const json::exception& e) {
    throw Error(ErrorCode::bad_input, "not usable JSON: " + printable(e.what()), file, "/");
  }
}

void JsonValue::fail(const std::string& reason) const {
  throw Error(ErrorCode::bad_input, reason, *file_, pointer_.empty() ? "/" : pointer_);
}

void JsonValue::fail_type(const char* wanted) const {
  fail(std::string("must be ") + wanted + ", not " + json_->type_name());
}

std::optional<JsonValue> JsonValue::find(const char* key) const {
  if (!json_->is_object()) fail_type("an object");
  const auto member = json_->find(key);
  if (member == json_->end()) return std::nullopt;
  return JsonValue(*member, *file_, pointer_ + "/" + key);
}

JsonValue JsonValue::at(const char* key) const {
  std::optional<JsonValue> member = find(key);
  if (!member) fail(std::string("'") + key + "' is missing");
  return *std::move(member);
}

void JsonValue::allow_only(std::initializer_list<std::string_view> members) const {
  if (!json_->is_object()) fail_type("an object");
  for (const auto& [key, value] : json_->items()) {
    if (std::find(members.begin(), members.end(), key) != members.end()) continue;
    std::string known;
    for (const std::string_view name : members)
      known.append(known.empty() ? "" : ", ").append(name);
    fail("unknown member '" + printable(key) + "'; known: " + known);
  }
}

std::size_t JsonValue::size() const {
  if (!json_->is_array()) fail_type("an array");
  return json_->size();
}

JsonValue JsonValue::operator[](std::size_t i) const {
  return {(*json_)[i], *file_, pointer_ + "/" + std::to_string(i)};
}

const std::string& JsonValue::string() const {
  if (!json_->is_string()) fail_type("a string");
  return json_->get_ref<const std::string&>();
}

bool JsonValue::boolean() const {
  if (!json_->is_boolean()) fail_type("true or false");
  return json_->get<bool>();
}

double JsonValue::number() const {
  if (!json_->is_number()) fail_type("a number");
  return json_->get<double>();
}

std::uint64_t JsonValue::integer() const {
  if (json_->is_number_unsigned()) return json_->get<std::uint64_t>();
  const double value = number();
  // Beyond 2^53 a double does not say which integer was meant.
  if (!(value >= 0 && value <= 0x1p53)) fail("must be an integer of 0 to 2^53");
  const auto integer = static_cast<std::uint64_t>(value);
  if (static_cast<double>(integer) != value) fail("must be an integer");
  return integer;
}

std::uint32_t JsonValue::index(std::size_t count, const char* what) const {
  const std::uint64_t i = integer();
  if (i >= count || i > UINT32_MAX)
    fail("index " + std::to_string(i) + " into a list of " + std::to_string(count) + " " + what);
  return static_cast<std::uint32_t>(i);
}

std::uint64_t integer_or(const JsonValue& object, const char* key, std::uint64_t otherwise) {
  const std::optional<JsonValue> member = object.find(key);
  return member ? member->integer() : otherwise;
}

std::string string_or(const JsonValue& object, const char* key, const std::string& otherwise) {
  const std::optional<JsonValue> member = object.find(key);
  return member ? member->string() : otherwise;
}

bool boolean_or(const JsonValue& object, const char* key, bool otherwise) {
  const std::optional<JsonValue> member = object.find(key);
  return member ? member->boolean() : otherwise;
}

}  // namespace strahl::gltf
