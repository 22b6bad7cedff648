// io/image_test.cpp - incomplete images are refused by name.
#include <string>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/io/image.h>

namespace strahl {
namespace {

std::string refusal(const Image& image) {
  try {
    require_complete(image, "out.png");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    return error.what();
  }
  return "accepted";
}

Image sample() {
  Image image{2, 3, std::vector<float>(18), {}, {}};
  image.float_channels.push_back({"Z", std::vector<float>(6)});
  image.uint_channels.push_back({"primitive_id", std::vector<std::uint32_t>(6)});
  return image;
}

TEST(Image, IsCompleteWithOneValuePerPixelAndChannel) { EXPECT_EQ(refusal(sample()), "accepted"); }

TEST(Image, NamesWhatIsMissing) {
  EXPECT_EQ(refusal(Image{}), "out.png: image of 0 x 0 pixels");
  Image image = sample();
  image.height = -3;
  EXPECT_EQ(refusal(image), "out.png: image of 2 x -3 pixels");
  image = sample();
  image.rgb.pop_back();
  EXPECT_EQ(refusal(image), "out.png: image has 17 colour values for 6 pixels");
  image = sample();
  image.uint_channels[0].values.pop_back();
  EXPECT_EQ(refusal(image), "out.png: image channel 'primitive_id' has 5 values for 6 pixels");
}

TEST(Image, RefusesChannelsThatShareAName) {
  Image image = sample();
  image.uint_channels[0].name = "Z";
  EXPECT_NE(refusal(image), "accepted");
  image.uint_channels[0].name = "R";
  EXPECT_NE(refusal(image), "accepted");
  image.uint_channels[0].name = "";
  EXPECT_NE(refusal(image), "accepted");
}

}  // namespace
}  // namespace strahl
