#include <bit>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/structures/wide_bvh/wide_any_order.h>

namespace strahl {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

void expect_just_below(float plane, std::uint32_t slot) {
  const float marked = with_ordered_slot(plane, slot);
  EXPECT_EQ(ordered_slot(marked), slot) << plane;
  EXPECT_LE(marked, plane) << slot;
  float above = marked;  // the next one with that slot would be above the plane
  do above = std::nextafter(above, kInf);
  while (ordered_slot(above) != slot && above <= plane);
  EXPECT_GT(above, plane) << slot;
}

TEST(WideAnyOrder, MarksTheGreatestFloatNotAbove) {
  const float tiny = std::numeric_limits<float>::denorm_min();
  for (const float plane : {0.0f, -0.0f, tiny, -tiny, 15 * tiny, 16 * tiny, -17 * tiny, 1.0f, -1.0f,
                            0x1p21f, -0x1p21f, 0x1.fffffep3f, -0x1.fffffep3f})
    for (std::uint32_t slot = 0; slot < 16; ++slot) expect_just_below(plane, slot);
  Rng rng(3);
  for (int i = 0; i < 1000; ++i) {
    const auto plane = static_cast<float>(std::ldexp(rng.uniform() - 0.5, int(rng.below(60)) - 40));
    expect_just_below(plane, static_cast<std::uint32_t>(rng.below(16)));
  }
}

TEST(WideAnyOrder, AMarkedPlaneOfAnEmptySlotIsAboveAllFrames) {
  for (std::uint32_t slot = 0; slot < 16; ++slot) {
    const float marked = with_ordered_slot(kInf, slot);
    EXPECT_EQ(ordered_slot(marked), slot);
    EXPECT_GT(marked, 0x1p127f);
  }
}

TEST(WideAnyOrder, VisitsWhatBlocksMuchForLittleFirst) {
  std::array<Blocking, kOrderedWidth> all;
  all[9] = {4.0, 4.0, 1.0};    // dense
  all[2] = {4.0, 4.0, 9.0};    // the same, but dear
  all[14] = {0.01, 4.0, 1.0};  // nearly empty
  const auto order = any_order(all);
  EXPECT_EQ(order[15], 9u);
  EXPECT_EQ(order[14], 2u);
  EXPECT_EQ(order[13], 14u);
  EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), kOrderedWidth);
}

TEST(WideAnyOrder, VisitsWhatHasNoAreaLast) {
  std::array<Blocking, kOrderedWidth> all;
  all[0] = {0.0, 2.0, 0.8};  // of nothing but points
  all[5] = {1.0, 0.0, 0.8};  // of boxes that were rounded away
  const auto order = any_order(all);
  EXPECT_EQ(order[15], 5u);
  for (const std::size_t later : {std::size_t{0}, std::size_t{14}}) EXPECT_NE(order[later], 5u);
  EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), kOrderedWidth);
}

}  // namespace
}  // namespace strahl
