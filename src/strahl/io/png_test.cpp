// io/png_test.cpp - pixels read back, the sRGB curve, and errors.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <png.h>

#include <strahl/base/error.h>
#include <strahl/io/png.h>
#include <strahl/io/temp_folder_test.h>

namespace strahl {
namespace {

using test::TempFolder;

std::vector<std::uint8_t> pixels_of(const std::filesystem::path& path, std::uint32_t width,
                                    std::uint32_t height) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&png, path.c_str()), 0) << png.message;
  EXPECT_EQ(png.width, width);
  EXPECT_EQ(png.height, height);
  EXPECT_EQ(png.format, static_cast<png_uint_32>(PNG_FORMAT_RGB)) << "8 bit, sRGB, no alpha";
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(png));
  EXPECT_NE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr), 0) << png.message;
  return pixels;
}

TEST(Png, EncodesTheStandardCurve) {
  EXPECT_EQ(srgb8(0.0f), 0);
  EXPECT_EQ(srgb8(1.0f), 255);
  EXPECT_EQ(srgb8(0.5f), 188);
  EXPECT_EQ(srgb8(0.2158605f), 128);
  EXPECT_EQ(srgb8(0.002f), 7);
}

TEST(Png, InvertsTheDecodingOfEveryByte) {
  for (int byte = 0; byte < 256; ++byte) {
    const double c = byte / 255.0;
    const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    EXPECT_EQ(srgb8(static_cast<float>(linear)), byte);
  }
}

TEST(Png, ClampsWhatIsOutOfRange) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(srgb8(-1.0f), 0);
  EXPECT_EQ(srgb8(-infinity), 0);
  EXPECT_EQ(srgb8(std::numeric_limits<float>::quiet_NaN()), 0);
  EXPECT_EQ(srgb8(2.0f), 255);
  EXPECT_EQ(srgb8(infinity), 255);
}

TEST(Png, KeepsRowsFromTheTopAndPixelsFromTheLeft) {
  const TempFolder folder;
  const Image image{3, 2, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0.5f, 0.5f, 0.5f, 0, 0, 0, 1, 1, 1}, {}, {}};
  write_png(folder / "a.png", image);
  const std::vector<std::uint8_t> expected{255, 0,   0,   0, 255, 0, 0,   0,   255,
                                           188, 188, 188, 0, 0,   0, 255, 255, 255};
  EXPECT_EQ(pixels_of(folder / "a.png", 3, 2), expected);
  EXPECT_EQ(folder.count(), 1);
}

TEST(Png, ReportsWhatCannotBeWrittenAndLeavesNothing) {
  const TempFolder folder;
  const Image pixel{1, 1, {0, 0, 0}, {}, {}};
  EXPECT_THROW(write_png(folder / "missing/a.png", pixel), Error);
  EXPECT_THROW(write_png(folder / "a.png", Image{}), Error);
  // libpng refuses widths above a million.
  const Image wide{1000001, 1, std::vector<float>(3000003), {}, {}};
  try {
    write_png(folder / "a.png", wide);
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::resource);
  }
  EXPECT_EQ(folder.count(), 0);
}

}  // namespace
}  // namespace strahl
