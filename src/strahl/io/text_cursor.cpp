// io/text_cursor.cpp - scanning of lines and tokens; numbers beyond what std::from_chars accepts.
#include <algorithm>
#include <charconv>
#include <limits>
#include <system_error>

#include <strahl/base/error.h>
#include <strahl/io/text_cursor.h>

namespace strahl {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

// std::from_chars takes no '+'; "+-1" must stay malformed.
std::string_view without_plus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  return token;
}

// Whether a well-formed decimal number that does not fit its type is too large rather than too
// small: its first non-zero digit decides, moved by the exponent.
bool is_too_large(std::string_view digits) {
  const std::size_t exponent_at = std::min(digits.find_first_of("eE"), digits.size());
  const std::string_view mantissa = digits.substr(0, exponent_at);
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first == std::string_view::npos) return false;
  std::string_view exponent = digits.substr(std::min(exponent_at + 1, digits.size()));
  if (!exponent.empty() && exponent[0] == '+') exponent.remove_prefix(1);
  const bool negative = !exponent.empty() && exponent[0] == '-';
  std::int64_t power = 0;
  const char* end = exponent.data() + exponent.size();
  if (std::from_chars(exponent.data(), end, power).ec == std::errc::result_out_of_range)
    return !negative;
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::int64_t magnitude =
      static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
  return power > -magnitude;
}

template <class T>
std::optional<T> parse_real(std::string_view token) {
  const std::string_view text = without_plus(token);
  const char* const end = text.data() + text.size();
  T value = 0;
  const std::from_chars_result result = std::from_chars(text.data(), end, value);
  if (result.ptr != end || result.ec == std::errc::invalid_argument) return std::nullopt;
  if (result.ec == std::errc::result_out_of_range) {
    value = is_too_large(text) ? std::numeric_limits<T>::infinity() : T(0);
    if (text[0] == '-') value = -value;
  }
  return value;
}

}  // namespace

std::optional<double> parse_number(std::string_view token) { return parse_real<double>(token); }
std::optional<float> parse_number32(std::string_view token) { return parse_real<float>(token); }

std::optional<std::int64_t> parse_integer(std::string_view token) {
  const std::string_view text = without_plus(token);
  const char* const end = text.data() + text.size();
  std::int64_t value = 0;
  const std::from_chars_result result = std::from_chars(text.data(), end, value);
  if (result.ptr != end || result.ec != std::errc()) return std::nullopt;
  return value;
}

std::string quote(std::string_view token) {
  constexpr std::size_t kShown = 40;
  std::string text = "'";
  for (const char c : token.substr(0, kShown)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (token.size() > kShown ? "...'" : "'");
}

std::string to_lower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

TextCursor::TextCursor(std::string_view text, std::string file_name, TextSyntax syntax,
                       std::size_t first_line)
    : text_(text), file_name_(std::move(file_name)), syntax_(syntax), line_(first_line) {
  if (text_.starts_with("\xEF\xBB\xBF")) position_ = 3;
}

bool TextCursor::at_newline() const {
  return position_ == text_.size() || is_line_end(text_[position_]);
}

bool TextCursor::at_continuation() const {
  return syntax_.line_continuation && text_[position_] == '\\' && position_ + 1 < text_.size() &&
         is_line_end(text_[position_ + 1]);
}

void TextCursor::skip_newline() {
  const bool pair = text_.substr(position_, 2) == "\r\n";
  position_ += pair ? 2 : 1;
  ++line_;
}

void TextCursor::skip_blanks() {
  while (position_ < text_.size()) {
    if (is_blank(text_[position_])) {
      ++position_;
    } else if (at_continuation()) {
      ++position_;
      skip_newline();
    } else {
      return;
    }
  }
}

bool TextCursor::at_line_end() {
  skip_blanks();
  if (at_newline()) return true;
  if (syntax_.comment == '\0' || text_[position_] != syntax_.comment) return false;
  rest_of_line();
  return true;
}

bool TextCursor::at_end() {
  while (at_line_end())
    if (!next_line()) return true;
  return false;
}

bool TextCursor::next_line() {
  while (!at_newline()) ++position_;
  if (position_ == text_.size()) return false;
  skip_newline();
  return true;
}

std::string_view TextCursor::token() {
  if (at_line_end()) return {};
  const std::size_t first = position_;
  while (!at_newline() && !is_blank(text_[position_]) && !at_continuation()) ++position_;
  return text_.substr(first, position_ - first);
}

std::string_view TextCursor::token_of_any_line() { return at_end() ? std::string_view{} : token(); }

std::string_view TextCursor::rest_of_line() {
  while (!at_newline() && is_blank(text_[position_])) ++position_;
  const std::size_t first = position_;
  while (!at_newline()) ++position_;
  std::size_t last = position_;
  while (last > first && is_blank(text_[last - 1])) --last;
  return text_.substr(first, last - first);
}

double TextCursor::to_number(std::string_view token, std::string_view what) const {
  if (const std::optional<double> value = parse_number(token)) return *value;
  if (token.empty()) fail("missing " + std::string(what));
  fail(std::string(what) + " is not a number: " + quote(token));
}

float TextCursor::to_number32(std::string_view token, std::string_view what) const {
  if (const std::optional<float> value = parse_number32(token)) return *value;
  if (token.empty()) fail("missing " + std::string(what));
  fail(std::string(what) + " is not a number: " + quote(token));
}

std::int64_t TextCursor::to_integer(std::string_view token, std::string_view what) const {
  if (const std::optional<std::int64_t> value = parse_integer(token)) return *value;
  if (token.empty()) fail("missing " + std::string(what));
  fail(std::string(what) + " is not a 64-bit integer: " + quote(token));
}

void TextCursor::fail(const std::string& reason) const {
  throw Error(ErrorCode::bad_input, reason, file_name_, where());
}

std::string TextCursor::where() const { return "line " + std::to_string(line_); }

}  // namespace strahl
