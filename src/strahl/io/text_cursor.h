// io/text_cursor.h - a scanner over the text of an input file: lines, tokens, numbers.
//
// Numbers are read by std::from_chars, independent of the locale and rounded to nearest. Lines end
// at LF, CR LF or a lone CR; a UTF-8 byte order mark at the start is skipped. A token is a run of
// bytes without blanks; there is no limit on the length of a token or a line.
// Thread safety: a value; one thread at a time per cursor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace strahl {

/// What a text format adds to lines and blanks.
struct TextSyntax {
  char comment = '\0';             ///< starts a comment at the start of a token; '\0': none
  bool line_continuation = false;  ///< a backslash before the end of a line joins it to the next
};

/// Scans `text` forward. The text must outlive the cursor and the views it returns.
/// All errors are Error{bad_input} naming the file and "line N".
class TextCursor {
 public:
  /// @param file_name cited in errors
  /// @param first_line number of the first line of `text`, from 1
  TextCursor(std::string_view text, std::string file_name, TextSyntax syntax = {},
             std::size_t first_line = 1);

  std::size_t line() const { return line_; }        ///< number of the current line, from 1
  std::size_t offset() const { return position_; }  ///< bytes scanned so far
  std::size_t remaining() const { return text_.size() - position_; }  ///< bytes left

  /// Skips blanks and a comment; true if no token is left on the current line.
  bool at_line_end();
  /// Skips blanks, comments and line ends; true if no token is left in the text.
  bool at_end();

  /// Moves behind the end of the current line, skipping what is left of it; false at end of text.
  bool next_line();

  /// The next token of the current line; empty at its end.
  std::string_view token();
  /// The next token on this or a later line; empty at the end of the text.
  std::string_view token_of_any_line();
  /// What is left of the current line without blanks at either end. Comments and continuations
  /// are not interpreted. The cursor stays at the end of the line.
  std::string_view rest_of_line();

  /// The next token of the current line as a number; "nan", "inf" and overflow give values that
  /// are not finite. Throws Error if it is missing or malformed. @param what names it in errors
  double number(std::string_view what) { return to_number(token(), what); }
  float number32(std::string_view what) { return to_number32(token(), what); }
  /// The next token of the current line as an integer. Throws Error if it is missing, malformed
  /// or beyond 64 bits. @param what names it in errors
  std::int64_t integer(std::string_view what) { return to_integer(token(), what); }

  /// A token of this text as a number: as above.
  double to_number(std::string_view token, std::string_view what) const;
  float to_number32(std::string_view token, std::string_view what) const;
  std::int64_t to_integer(std::string_view token, std::string_view what) const;

  /// Throws Error{bad_input} with `reason`, naming the file and the current line.
  [[noreturn]] void fail(const std::string& reason) const;
  /// "line N", for warnings.
  std::string where() const;

 private:
  void skip_blanks();
  bool at_newline() const;
  bool at_continuation() const;
  void skip_newline();

  std::string_view text_;
  std::string file_name_;
  TextSyntax syntax_;
  std::size_t position_ = 0;
  std::size_t line_;
};

/// The whole of `token` as a number: decimal or scientific, a sign (also '+'), "2.", ".5", "1E2",
/// "nan", "inf", "infinity" in any case. Beyond the largest finite value: infinity; below the
/// smallest: 0. Nothing if it is none of these.
std::optional<double> parse_number(std::string_view token);
std::optional<float> parse_number32(std::string_view token);

/// The whole of `token` as a decimal integer, with a sign or '+'. Nothing if it is not one or does
/// not fit 64 bits.
std::optional<std::int64_t> parse_integer(std::string_view token);

/// The token in quotes for a message: shortened, unprintable bytes as '?'.
std::string quote(std::string_view token);

/// Lower-case copy; only the letters of ASCII change.
std::string to_lower(std::string_view text);

}  // namespace strahl
