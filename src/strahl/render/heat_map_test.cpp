#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <strahl/render/heat_map.h>

namespace strahl {
namespace {

TEST(HeatMap, TheScaleLeavesOutExtremesAndWhatIsNotFinite) {
  std::vector<float> values(1000, 3.0f);
  values[0] = 1e6f, values[1] = std::numeric_limits<float>::infinity();
  values[2] = std::nanf("");
  EXPECT_EQ(heat_scale(values), 3.0);
  EXPECT_EQ(heat_scale({}), 0.0);
  EXPECT_EQ(heat_scale({2.0f}), 2.0);
}

TEST(HeatMap, MoreIsBrighter) {
  const std::vector<float> rgb = heat_map(std::vector<float>{0.0f, 5.0f, 10.0f, 50.0f}, 10.0);
  ASSERT_EQ(rgb.size(), 12u);
  EXPECT_LT(rgb[0], rgb[3]);
  EXPECT_LT(rgb[3], rgb[6]);
  EXPECT_EQ(rgb[6], rgb[9]);  // above the scale
  EXPECT_LT(rgb[2], 0.1f);
  EXPECT_EQ(heat_map(std::vector<float>{7.0f}, 0.0), heat_map(std::vector<float>{0.0f}, 1.0));
}

TEST(HeatMap, DifferencesAreBlueWhereLessRedWhereMoreWhiteWhereAlike) {
  const std::vector<float> a{1.0f, 9.0f, 4.0f}, b{9.0f, 1.0f, 4.0f};
  const std::vector<float> rgb = difference_map(a, b, 8.0);
  EXPECT_LT(rgb[0], rgb[2]);
  EXPECT_GT(rgb[3], rgb[5]);
  EXPECT_EQ(*std::min_element(rgb.begin() + 6, rgb.end()), 1.0f);
  EXPECT_EQ(difference_map(a, b, 0.0), std::vector<float>(9, 1.0f));
}

}  // namespace
}  // namespace strahl
