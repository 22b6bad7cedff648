// base/hash_test.cpp - published vectors, and independence of how the bytes are cut.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/hash.h>

namespace strahl {
namespace {

std::uint64_t hash_of(std::string_view text) {
  Hash64 hash;
  hash.add(text);
  return hash.digest();
}

TEST(Hash64, GivesThePublishedVectors) {
  EXPECT_EQ(hash_of(""), 0xEF46DB3751D8E999u);
  EXPECT_EQ(hash_of("a"), 0xD24EC4F1A98C6E5Bu);
  EXPECT_EQ(hash_of("abc"), 0x44BC2CF5AD770999u);
  EXPECT_EQ(hash_of("Nobody inspects the spammish repetition"), 0xFBCEA83C8A378BF1u);
}

TEST(Hash64, DoesNotDependOnHowTheBytesAreCut) {
  std::string text;
  for (int i = 0; i < 200; ++i) text += static_cast<char>('a' + (i * 7) % 26);
  const std::uint64_t whole = hash_of(text);
  for (std::size_t first = 0; first <= text.size(); ++first) {
    Hash64 hash;
    hash.add(std::string_view(text).substr(0, first));
    hash.digest();  // asking in between changes nothing
    hash.add(std::string_view(text).substr(first));
    ASSERT_EQ(hash.digest(), whole) << "cut at " << first;
  }
  Hash64 bytewise;
  for (const char c : text) bytewise.add(c);
  EXPECT_EQ(bytewise.digest(), whole);
}

TEST(Hash64, ChangesWithAnySingleByteAndWithTheLength) {
  const std::string text(100, 'x');
  const std::uint64_t before = hash_of(text);
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string other = text;
    other[i] = 'y';
    ASSERT_NE(hash_of(other), before) << i;
  }
  EXPECT_NE(hash_of(text + 'x'), before);
}

TEST(Hash64, HashesTheBitsOfNumbers) {
  Hash64 plus;
  Hash64 minus;
  plus.add(0.0);
  minus.add(-0.0);
  EXPECT_NE(plus.digest(), minus.digest());
  const std::vector<double> values{1.5, 2.5};
  Hash64 array;
  Hash64 singly;
  array.add(std::span<const double>(values));
  singly.add(1.5);
  singly.add(2.5);
  EXPECT_EQ(array.digest(), singly.digest());
}

TEST(Hash64, PrintsSixteenDigits) {
  EXPECT_EQ(to_hex(0x0123456789ABCDEFu), "0123456789abcdef");
  EXPECT_EQ(to_hex(1), "0000000000000001");
}

}  // namespace
}  // namespace strahl
