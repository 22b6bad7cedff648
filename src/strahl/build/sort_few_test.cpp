#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/build/sort_few.h>

namespace strahl {
namespace {

/// What sorts all sequences of 0 and 1 sorts all sequences.
TEST(SortFew, SortsAllSequencesOfZerosAndOnes) {
  for (std::size_t count = 0; count <= 16; ++count)
    for (std::uint32_t bits = 0; bits < 1u << count; ++bits) {
      std::vector<std::uint32_t> values;
      for (std::size_t i = 0; i < count; ++i) values.push_back(bits >> i & 1u);
      sort_few(values);
      ASSERT_TRUE(std::is_sorted(values.begin(), values.end())) << count << ' ' << bits;
    }
}

TEST(SortFew, KeepsWhatItSorts) {
  Rng rng(1);
  for (std::size_t count = 0; count <= 40; ++count) {
    std::vector<std::uint32_t> values;
    for (std::size_t i = 0; i < count; ++i)
      values.push_back(i % 5 == 0 ? ~0u : static_cast<std::uint32_t>(rng.below(20)));
    std::vector<std::uint32_t> expected = values;
    std::sort(expected.begin(), expected.end());
    sort_few(values);
    EXPECT_EQ(values, expected);
  }
}

}  // namespace
}  // namespace strahl
