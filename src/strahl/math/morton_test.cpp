#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/math/morton.h>

namespace strahl {
namespace {

TEST(Morton, SpreadsEveryBit) {
  for (int bit = 0; bit < 21; ++bit)
    EXPECT_EQ(spread_bits(std::uint64_t{1} << bit), std::uint64_t{1} << 3 * bit);
  EXPECT_EQ(spread_bits(~std::uint64_t{0}), 0x1249249249249249u);
  EXPECT_EQ(morton_code(1, 0, 0), 4u);
  EXPECT_EQ(morton_code(0, 1, 0), 2u);
  EXPECT_EQ(morton_code(0, 0, 1), 1u);
}

TEST(Morton, CodesSortByOctants) {
  const MortonFrame frame({{-1, -2, -3}, {1, 2, 3}});
  Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d p{rng.uniform(-1, 1), rng.uniform(-2, 2), rng.uniform(-3, 3)};
    const std::uint64_t octant = (p.x >= 0 ? 4u : 0u) + (p.y >= 0 ? 2u : 0u) + (p.z >= 0 ? 1u : 0u);
    EXPECT_EQ(frame.code(p) >> 60, octant);
  }
}

TEST(Morton, KeepsToTheFrame) {
  const MortonFrame frame({{0, 0, 5}, {1, 1, 5}});  // flat
  EXPECT_EQ(frame.code({0, 0, 5}), 0u);
  EXPECT_EQ(frame.code({1, 1, 5}), morton_code(0x1fffff, 0x1fffff, 0));
  EXPECT_EQ(frame.code({9, 9, 9}), frame.code({1, 1, 5}));
  EXPECT_EQ(frame.code({-9, -9, -9}), 0u);
  const MortonFrame huge({Vec3d::all(-0x1p240), Vec3d::all(0x1p240)});
  EXPECT_EQ(huge.code(Vec3d::all(0.0)), morton_code(1u << 20, 1u << 20, 1u << 20));
}

}  // namespace
}  // namespace strahl
