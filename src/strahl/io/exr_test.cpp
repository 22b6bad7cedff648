// io/exr_test.cpp - every value comes back with its bits, and bad files are refused.
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/io/exr.h>
#include <strahl/io/temp_folder_test.h>

namespace strahl {
namespace {

using test::TempFolder;

Image sample() {
  const float infinity = std::numeric_limits<float>::infinity();
  Image image{3, 2, {}, {}, {}};
  for (int i = 0; i < 18; ++i) image.rgb.push_back(static_cast<float>(i) * 1.1f);
  image.float_channels.push_back({"N.X", {1, 0, -1, 0.1f, 0.2f, 0.3f}});
  image.float_channels.push_back({"Z", {1.25f, infinity, 3, 4, 1e-40f, -0.0f}});
  image.uint_channels.push_back({"primitive_id", {0, 1, 2, 3, 4294967294u, 4294967295u}});
  return image;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

TEST(Exr, RoundTripsColourDepthNormalsAndIdsBitByBit) {
  const TempFolder folder;
  const Image image = sample();
  write_exr(folder / "a.exr", image);
  const Image read = read_exr(folder / "a.exr");
  EXPECT_EQ(read.width, 3);
  EXPECT_EQ(read.height, 2);
  EXPECT_TRUE(same_bits(read.rgb, image.rgb));
  ASSERT_EQ(read.float_channels.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read.float_channels[i].name, image.float_channels[i].name);
    EXPECT_TRUE(same_bits(read.float_channels[i].values, image.float_channels[i].values));
  }
  ASSERT_EQ(read.uint_channels.size(), 1u);
  EXPECT_EQ(read.uint_channels[0].name, "primitive_id");
  EXPECT_EQ(read.uint_channels[0].values, image.uint_channels[0].values);
}

TEST(Exr, IsByteIdenticalForEqualImages) {
  const TempFolder folder;
  write_exr(folder / "a.exr", sample());
  write_exr(folder / "b.exr", sample());
  EXPECT_EQ(folder.read("a.exr"), folder.read("b.exr"));
  EXPECT_EQ(folder.count(), 2);
}

TEST(Exr, RefusesEveryTruncationAndOtherFiles) {
  const TempFolder folder;
  write_exr(folder / "a.exr", sample());
  const std::string file = folder.read("a.exr");
  for (std::size_t length = 0; length < file.size(); ++length) {
    folder.write("cut.exr", file.substr(0, length));
    EXPECT_THROW(read_exr(folder / "cut.exr"), Error) << length;
  }
  EXPECT_THROW(read_exr(folder / "missing.exr"), Error);
}

TEST(Exr, RefusesAWindowFarLargerThanTheFile) {
  const TempFolder folder;
  write_exr(folder / "a.exr", sample());
  std::string file = folder.read("a.exr");
  const std::string key("dataWindow\0box2i\0", 17);
  const std::size_t window = file.find(key) + key.size() + 4;  // behind the attribute's size
  const std::int32_t largest[] = {99999, 99999};
  std::memcpy(file.data() + window + 8, largest, sizeof largest);
  folder.write("a.exr", file);
  EXPECT_THROW(read_exr(folder / "a.exr"), Error);
}

TEST(Exr, ReportsWhatCannotBeWrittenAndLeavesNothing) {
  const TempFolder folder;
  EXPECT_THROW(write_exr(folder / "missing/a.exr", sample()), Error);
  Image image = sample();
  image.rgb.clear();
  EXPECT_THROW(write_exr(folder / "a.exr", image), Error);
  EXPECT_EQ(folder.count(), 0);
}

}  // namespace
}  // namespace strahl
