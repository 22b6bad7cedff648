// base/options.cpp - reading and writing single option values, and the messages about bad ones.
//
// Numbers go through std::from_chars and std::to_chars: independent of the locale, and the shortest
// text that reads back to the same value.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include <strahl/base/error.h>
#include <strahl/base/options.h>

namespace strahl::option_detail {
namespace {

template <class T>
bool read_whole(std::string_view text, T& value) {
  T parsed{};
  const char* end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, parsed);
  if (result.ec != std::errc() || result.ptr != end) return false;
  value = parsed;
  return true;
}

template <class T>
std::string write_number(T value) {
  char buffer[32];  // the longest double, -2.2250738585072014e-308, takes 24
  const std::to_chars_result result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, result.ptr);
}

bool is_spec_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ||
         std::string_view("_:=,().+-").find(c) != std::string_view::npos;
}

/// The length of the parenthesised group that `text` begins with; 0 if there is none.
std::size_t leading_group(std::string_view text) {
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    depth += text[i] == '(';
    depth -= text[i] == ')';
    if (depth <= 0) return depth == 0 && text[i] == ')' ? i + 1 : 0;
  }
  return 0;
}

bool is_balanced(std::string_view text) {
  int depth = 0;
  for (const char c : text) {
    depth += c == '(';
    depth -= c == ')';
    if (depth < 0) return false;
  }
  return depth == 0;
}

template <class Strings>
std::string join(const Strings& parts) {
  std::string text;
  for (const std::string& part : parts) {
    if (!text.empty()) text += ", ";
    text += part;
  }
  return text;
}

std::string accepted(const OptionInfo& info) {
  if (!info.values.empty()) return "one of " + join(info.values);
  if (info.type == "spec") return "a structure, with options in parentheses: (name:key=value,...)";
  const std::string kind = info.type == "double" ? "a number" : "a whole number";
  return kind + " in " + info.min + ".." + info.max;
}

std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

}  // namespace

bool read(std::string_view text, bool& value) {
  const bool is_on = text == "on" || text == "true" || text == "1";
  const bool is_off = text == "off" || text == "false" || text == "0";
  if (is_on || is_off) value = is_on;
  return is_on || is_off;
}

bool read(std::string_view text, int& value) { return read_whole(text, value); }

bool read(std::string_view text, std::uint64_t& value) { return read_whole(text, value); }

bool read(std::string_view text, double& value) {
  double parsed = 0;
  if (!read_whole(text, parsed) || !std::isfinite(parsed)) return false;
  value = parsed + 0.0;  // -0 becomes +0, so that equal options have equal text
  return true;
}

bool read_spec(std::string_view text, std::string& value) {
  if (!text.empty() && leading_group(text) == text.size()) text = text.substr(1, text.size() - 2);
  if (text.empty() || !std::all_of(text.begin(), text.end(), is_spec_character)) return false;
  if (text.front() < 'a' || text.front() > 'z' || !is_balanced(text)) return false;
  value = std::string(text);
  return true;
}

std::string write(bool value) { return value ? "on" : "off"; }
std::string write(int value) { return write_number(value); }
std::string write(std::uint64_t value) { return write_number(value); }
std::string write(double value) { return write_number(value); }

std::string write_spec(const std::string& value) {
  const bool is_bare_name = value.find_first_of(":,=()") == std::string::npos;
  return is_bare_name ? value : "(" + value + ")";
}

void check_keys(std::span<const OptionValue> given, std::span<const std::string> known,
                std::string_view structure) {
  for (std::size_t i = 0; i < given.size(); ++i) {
    const std::string& key = given[i].key;
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      const std::string rest =
          known.empty() ? "it takes no options" : "known options: " + join(known);
      throw Error(ErrorCode::usage, "unknown option " + quoted(key) + "; " + rest,
                  std::string(structure));
    }
    const auto is_same = [&](const OptionValue& other) { return other.key == key; };
    const auto here = given.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::any_of(given.begin(), here, is_same)) {
      throw Error(ErrorCode::usage, "given more than once", std::string(structure) + "." + key);
    }
  }
}

void refuse_value(std::string_view structure, const OptionInfo& info, std::string_view value) {
  throw Error(ErrorCode::usage, "got " + quoted(value) + ", expected " + accepted(info),
              std::string(structure) + "." + info.name);
}

void append(std::string& list, std::string_view key, std::string_view value) {
  if (!list.empty()) list += ',';
  list.append(key).append("=").append(value);
}

}  // namespace strahl::option_detail
