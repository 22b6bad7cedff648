// base/rng_test.cpp - the published sequence, and ranges.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>

namespace strahl {
namespace {

TEST(Rng, GivesThePublishedSequenceForSeed42Stream54) {
  Rng rng(42, 54);
  for (const std::uint32_t expected :
       {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u, 0xbfa4784bu, 0xcbed606eu}) {
    EXPECT_EQ(rng.next_u32(), expected);
  }
}

TEST(Rng, RepeatsForEqualSeedsAndDiffersForOthers) {
  Rng a(7);
  Rng b(7);
  Rng other_seed(8);
  Rng other_stream(7, 1);
  const std::uint64_t first = a.next_u64();
  EXPECT_EQ(first, b.next_u64());
  EXPECT_NE(first, other_seed.next_u64());
  EXPECT_NE(first, other_stream.next_u64());
}

TEST(Rng, MakesDoublesOf53BitsFromTwoOutputs) {
  Rng rng(42, 54);
  const std::uint64_t bits = 0xa15c02b77b47f409u >> 11;
  EXPECT_EQ(rng.uniform(), static_cast<double>(bits) / 9007199254740992.0);
  // Small results have bits to spare, yet never use more than 53 behind the point.
  for (int i = 0; i < 10000; ++i) {
    const double scaled = rng.uniform() * 9007199254740992.0;
    ASSERT_EQ(scaled, std::floor(scaled));
  }
}

TEST(Rng, KeepsDoublesInTheHalfOpenIntervalWithTheRightMean) {
  Rng rng(1);
  double sum = 0;
  constexpr int kDraws = 100000;
  for (int i = 0; i < kDraws; ++i) {
    const double x = rng.uniform();
    ASSERT_GE(x, 0.0);
    ASSERT_LT(x, 1.0);
    sum += x;
  }
  EXPECT_NEAR(sum / kDraws, 0.5, 0.005);
}

TEST(Rng, DrawsEveryNumberBelowNEquallyOften) {
  Rng rng(3);
  std::array<int, 6> counts{};
  for (int i = 0; i < 60000; ++i) ++counts.at(rng.below(6));
  for (const int count : counts) EXPECT_NEAR(count, 10000, 500);
  EXPECT_EQ(rng.below(1), 0u);
}

}  // namespace
}  // namespace strahl
