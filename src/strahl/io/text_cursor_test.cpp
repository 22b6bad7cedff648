// io/text_cursor_test.cpp - lines, tokens and numbers of text formats.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/io/text_cursor.h>

namespace strahl {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

std::string error_of(const auto& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(TextCursor, ReadsEveryUsualNotationOfNumbers) {
  EXPECT_EQ(parse_number("+1.5"), 1.5);
  EXPECT_EQ(parse_number("2."), 2.0);
  EXPECT_EQ(parse_number(".5"), 0.5);
  EXPECT_EQ(parse_number("-.5e1"), -5.0);
  EXPECT_EQ(parse_number("1E2"), 100.0);
  EXPECT_EQ(parse_number("1e-05"), 1e-05);
  EXPECT_EQ(parse_number("0.1"), 0.1);
  EXPECT_EQ(parse_number32("0.1"), 0.1f);
}

TEST(TextCursor, RoundsFloat32OnceNotThroughFloat64) {
  // Just above the midpoint of 1 and the next float; rounding through double loses the excess.
  EXPECT_EQ(parse_number32("1.00000005960464477540"), std::nextafter(1.0f, 2.0f));
}

TEST(TextCursor, OverflowIsInfinityAndUnderflowIsZero) {
  EXPECT_EQ(parse_number("1e400"), kInf);
  EXPECT_EQ(parse_number("-1e400"), -kInf);
  EXPECT_EQ(parse_number("1e99999999999999999999"), kInf);
  EXPECT_EQ(parse_number("0.001e312"), kInf);
  EXPECT_EQ(parse_number("1e-400"), 0.0);
  EXPECT_TRUE(std::signbit(*parse_number("-1e-400")));
  EXPECT_EQ(parse_number("1e-99999999999999999999"), 0.0);
  EXPECT_EQ(parse_number("0e99999"), 0.0);
  EXPECT_EQ(parse_number("1000000e-350"), 0.0);
  EXPECT_EQ(parse_number(std::string(400, '9')), kInf);
  EXPECT_EQ(parse_number("0." + std::string(400, '0') + "1"), 0.0);
  EXPECT_EQ(parse_number("4.9e-324"), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(parse_number32("1e40"), std::numeric_limits<float>::infinity());
  EXPECT_EQ(parse_number32("1e-40"), 1e-40f);
}

TEST(TextCursor, WordsForNotFiniteValuesAreNumbers) {
  EXPECT_TRUE(std::isnan(*parse_number("nan")));
  EXPECT_TRUE(std::isnan(*parse_number("-NaN")));
  EXPECT_EQ(parse_number("Inf"), kInf);
  EXPECT_EQ(parse_number("-infinity"), -kInf);
  EXPECT_EQ(parse_number("+inf"), kInf);
}

TEST(TextCursor, RefusesWhatIsNotANumber) {
  for (const char* text : {"", "abc", "1x", "+", "-", "+-1", "++1", "1e", ".", "0x10", "1,5", "--1",
                           "1 ", " 1", "1e+"})
    EXPECT_FALSE(parse_number(text)) << "'" << text << "'";
  EXPECT_FALSE(parse_number(std::string_view("1\0", 2)));
}

TEST(TextCursor, ReadsIntegersAndRefusesWhatDoesNotFit) {
  EXPECT_EQ(parse_integer("-12"), -12);
  EXPECT_EQ(parse_integer("+7"), 7);
  EXPECT_EQ(parse_integer("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
  for (const char* text : {"", "9223372036854775808", "1.0", "1/2", "+-3", "0x1"})
    EXPECT_FALSE(parse_integer(text)) << text;
}

TEST(TextCursor, CountsLinesOfEveryEnding) {
  TextCursor cursor("a\nb\r\nc\rd", "f");
  for (const char* expected : {"a", "b", "c", "d"}) EXPECT_EQ(cursor.token_of_any_line(), expected);
  EXPECT_EQ(cursor.line(), 4u);
  EXPECT_TRUE(cursor.at_end());
  EXPECT_FALSE(cursor.next_line());
}

TEST(TextCursor, TokensStopAtTheEndOfTheLine) {
  TextCursor cursor("  a \t b\nc", "f");
  EXPECT_EQ(cursor.token(), "a");
  EXPECT_EQ(cursor.token(), "b");
  EXPECT_TRUE(cursor.at_line_end());
  EXPECT_EQ(cursor.token(), "");
  EXPECT_TRUE(cursor.next_line());
  EXPECT_EQ(cursor.token(), "c");
}

TEST(TextCursor, SkipsCommentsOnlyAtTheStartOfATokenAndOnlyWhenAsked) {
  TextCursor with("a#1 # b c\n#d\ne", "f", {.comment = '#'});
  EXPECT_EQ(with.token(), "a#1");
  EXPECT_EQ(with.token(), "");
  EXPECT_EQ(with.token_of_any_line(), "e");
  EXPECT_EQ(with.line(), 3u);
  TextCursor without("# b", "f");
  EXPECT_EQ(without.token(), "#");
}

TEST(TextCursor, JoinsContinuedLinesWhenAsked) {
  TextCursor cursor("a \\\nb\\\r\nc\nd \\", "f", {.line_continuation = true});
  EXPECT_EQ(cursor.token(), "a");
  EXPECT_EQ(cursor.token(), "b");
  EXPECT_EQ(cursor.token(), "c");
  EXPECT_EQ(cursor.line(), 3u);
  EXPECT_TRUE(cursor.at_line_end());
  EXPECT_EQ(cursor.token_of_any_line(), "d");
  EXPECT_EQ(cursor.token(), "\\");
}

TEST(TextCursor, GivesTheRestOfALineWithoutOuterBlanks) {
  TextCursor cursor("name  my file.mtl \r\nx", "f");
  EXPECT_EQ(cursor.token(), "name");
  EXPECT_EQ(cursor.rest_of_line(), "my file.mtl");
  EXPECT_EQ(cursor.token_of_any_line(), "x");
}

TEST(TextCursor, SkipsAByteOrderMark) {
  TextCursor cursor("\xEF\xBB\xBFv 1", "f");
  EXPECT_EQ(cursor.token(), "v");
}

TEST(TextCursor, ErrorsNameFileLineAndToken) {
  TextCursor cursor("1\n2 q\x01", "mesh.obj");
  EXPECT_EQ(cursor.number("x"), 1.0);
  EXPECT_EQ(error_of([&] { cursor.number("y"); }), "mesh.obj: line 1: missing y");
  cursor.next_line();
  EXPECT_EQ(cursor.integer("count"), 2);
  EXPECT_EQ(error_of([&] { cursor.integer("count"); }),
            "mesh.obj: line 2: count is not a 64-bit integer: 'q?'");
}

TEST(TextCursor, MessagesStayShort) {
  EXPECT_EQ(quote(std::string(1000, 'x')), "'" + std::string(40, 'x') + "...'");
}

}  // namespace
}  // namespace strahl
