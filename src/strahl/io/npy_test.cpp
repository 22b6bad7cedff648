// io/npy_test.cpp - arrays written and mapped again.
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/io/npy.h>
#include <strahl/io/temp_folder_test.h>

namespace strahl {
namespace {

using test::TempFolder;
using Shape = std::vector<std::uint64_t>;

template <class T>
void expect_round_trip(const std::vector<T>& values, const char* descr) {
  const TempFolder folder;
  write_npy(folder / "a.npy", npy_array(values));
  const NpyView view(folder / "a.npy");
  EXPECT_EQ(npy_descr(view.dtype()), descr);
  EXPECT_EQ(view.shape(), Shape{values.size()});
  const std::span<const T> read = view.as<T>();
  EXPECT_EQ(std::vector<T>(read.begin(), read.end()), values);
}

TEST(Npy, RoundTripsEveryDtype) {
  expect_round_trip<float>({1.5f, -0.0f, std::numeric_limits<float>::infinity()}, "<f4");
  expect_round_trip<double>({0.1, 1e-310, -2.0}, "<f8");
  expect_round_trip<std::uint32_t>({0, 4294967295u}, "<u4");
  expect_round_trip<std::int64_t>({INT64_MIN, 7}, "<i8");
  expect_round_trip<std::int8_t>({-1, 0, 1}, "|i1");
  expect_round_trip<std::uint8_t>({1, 0, 1}, "|b1");
}

TEST(Npy, KeepsRowsTogether) {
  const TempFolder folder;
  const std::vector<double> values{1, 2, 3, 4, 5, 6};
  write_npy(folder / "a.npy", npy_array(values, 3));
  const NpyView view(folder / "a.npy");
  EXPECT_EQ(view.shape(), (Shape{2, 3}));
  EXPECT_EQ(view.as<double>()[3], 4.0);
  EXPECT_EQ(view.description(), "dtype '<f8', shape (2, 3)");
}

TEST(Npy, WritesAndReadsNoElementsAtAll) {
  const TempFolder folder;
  write_npy(folder / "a.npy", npy_array(std::vector<double>{}, 6));
  const NpyView view(folder / "a.npy");
  EXPECT_EQ(view.shape(), (Shape{0, 6}));
  EXPECT_TRUE(view.as<double>().empty());
}

TEST(Npy, ReportsTheDtypeGotWhenAnotherIsAskedFor) {
  const TempFolder folder;
  write_npy(folder / "a.npy", npy_array(std::vector<float>{1, 2, 3, 4, 5}, 5));
  const NpyView view(folder / "a.npy");
  try {
    view.as<double>();
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    EXPECT_EQ(error.reason(), "got dtype '<f4', shape (1, 5), expected dtype '<f8'");
    EXPECT_EQ(error.which(), view.which());
  }
}

TEST(Npy, AlignsDataThatAWriterLeftUnaligned) {
  const TempFolder folder;
  const std::string literal = "{'descr': '<f8', 'fortran_order': False, 'shape': (2,)}";
  std::string file("\x93NUMPY\x01\x00", 8);
  file += {static_cast<char>(literal.size()), '\0'};
  file += literal;
  ASSERT_NE(file.size() % 8, 0u);
  const double values[] = {0.25, -3.0};
  file.append(reinterpret_cast<const char*>(values), sizeof values);
  NpyView view(folder.write("a.npy", file));
  const NpyView moved = std::move(view);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(moved.data()) % alignof(double), 0u);
  EXPECT_EQ(moved.as<double>()[0], 0.25);
  EXPECT_EQ(moved.as<double>()[1], -3.0);
}

TEST(Npy, RefusesFilesThatAreNone) {
  const TempFolder folder;
  EXPECT_THROW(NpyView(folder / "missing.npy"), Error);
  EXPECT_THROW(NpyView(folder.write("empty.npy", "")), Error);
  EXPECT_THROW(NpyView(folder.write("text.npy", "1 2 3\n4 5 6\n")), Error);
}

}  // namespace
}  // namespace strahl
