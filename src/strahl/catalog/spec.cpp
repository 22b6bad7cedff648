#include <strahl/base/error.h>
#include <strahl/catalog/catalog.h>

namespace strahl {
namespace {

[[noreturn]] void refuse(std::string_view text, std::size_t at, const std::string& expected) {
  throw Error(ErrorCode::usage, expected, "SPEC '" + std::string(text) + "'",
              "column " + std::to_string(at + 1));
}

bool is_word_char(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; }
bool is_value_char(char c) { return is_word_char(c) || c == '.' || c == '-' || c == '+'; }

/// First position at or after `from` whose character fails `accepts`.
std::size_t skip(std::string_view text, std::size_t from, bool (*accepts)(char)) {
  while (from < text.size() && accepts(text[from])) ++from;
  return from;
}

/// Position behind the parenthesis that closes the one at `open`.
std::size_t skip_parentheses(std::string_view text, std::size_t open) {
  std::size_t depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    depth += text[i] == '(';
    depth -= text[i] == ')';
    if (depth == 0) return i + 1;
  }
  refuse(text, open, "this parenthesis is never closed");
}

std::size_t parse_option(std::string_view text, std::size_t at, Spec& spec) {
  const std::size_t equals = skip(text, at, is_word_char);
  if (equals == at || equals == text.size() || text[equals] != '=')
    refuse(text, at, "expected key=value");
  const std::size_t value = equals + 1;
  std::size_t end;
  if (value < text.size() && text[value] == '(') {
    end = skip_parentheses(text, value);
    parse_spec(text.substr(value + 1, end - value - 2));
  } else {
    end = skip(text, value, is_value_char);
  }
  if (end == value) refuse(text, value, "expected a number, a word or a SPEC in parentheses");
  std::string key(text.substr(at, equals - at));
  for (const OptionValue& earlier : spec.options)
    if (earlier.key == key) refuse(text, at, "option '" + key + "' is given twice");
  spec.options.push_back({std::move(key), std::string(text.substr(value, end - value))});
  return end;
}

/// Whether the text starts with `key=`, so that it continues the SPEC before it.
bool starts_with_option(std::string_view item) {
  const std::size_t end = skip(item, 0, is_word_char);
  return end > 0 && end < item.size() && item[end] == '=';
}

}  // namespace

Spec parse_spec(std::string_view text) {
  Spec spec;
  std::size_t at = skip(text, 0, is_word_char);
  if (at == 0) refuse(text, 0, "expected the name of a structure");
  spec.name = text.substr(0, at);
  if (at == text.size()) return spec;
  if (text[at] != ':') refuse(text, at, "expected ':' and options after the name");
  for (;;) {
    at = parse_option(text, at + 1, spec);
    if (at == text.size()) return spec;
    if (text[at] != ',') refuse(text, at, "expected ',' or the end");
  }
}

std::vector<std::string> split_specs(std::string_view list) {
  std::vector<std::string> specs;
  std::size_t begin = 0, depth = 0;
  for (std::size_t i = 0; i <= list.size(); ++i) {
    if (i < list.size()) {
      depth += list[i] == '(';
      depth -= list[i] == ')' && depth > 0;
      if (list[i] != ',' || depth > 0) continue;
    }
    const std::string_view item = list.substr(begin, i - begin);
    begin = i + 1;
    if (!specs.empty() && starts_with_option(item))
      specs.back() += "," + std::string(item);
    else if (!item.empty() || !list.empty())
      specs.emplace_back(item);
  }
  return specs;
}

std::string canonical_spec(std::string_view name, const std::string& options) {
  return options.empty() ? std::string(name) : std::string(name) + ":" + options;
}

}  // namespace strahl
