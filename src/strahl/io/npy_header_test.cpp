// io/npy_header_test.cpp - headers byte for byte, and every way in which one can be wrong.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/io/npy_header.h>

namespace strahl {
namespace {

using Shape = std::vector<std::uint64_t>;

/// An NPY file with this dictionary literal and `data_bytes` zeros.
std::string npy_file(const std::string& literal, std::size_t data_bytes, int version = 1) {
  std::string file = "\x93NUMPY";
  file += {static_cast<char>(version), '\0', static_cast<char>(literal.size() & 0xFF),
           static_cast<char>(literal.size() >> 8)};
  if (version > 1) file += {'\0', '\0'};
  return file + literal + std::string(data_bytes, '\0');
}

std::string refusal(const std::string& file) {
  try {
    parse_npy_header(file, "rays.npy");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    EXPECT_EQ(error.which(), "rays.npy");
    return error.what();
  }
  return "accepted";
}

std::string refusal_of_literal(const std::string& literal) {
  return refusal(npy_file(literal, 24));
}

TEST(NpyHeader, IsWrittenAsNumPyWritesIt) {
  const std::string header = format_npy_header(NpyDtype::f8, {3, 6});
  const std::string literal = "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 6), }";
  ASSERT_EQ(header.size(), 128u);
  EXPECT_EQ(header.substr(0, 10), std::string("\x93NUMPY\x01\x00\x76\x00", 10));
  EXPECT_EQ(header.substr(10, literal.size()), literal);
  EXPECT_EQ(header.find_first_not_of(' ', 10 + literal.size()), 127u);
  EXPECT_EQ(header[127], '\n');
}

TEST(NpyHeader, IsAlwaysAMultipleOf64Bytes) {
  for (std::uint64_t extent = 1; extent < 10000000000000000000u / 10; extent *= 10) {
    for (const Shape& shape : {Shape{extent}, Shape{extent, 3}, Shape{extent, extent, 1}}) {
      EXPECT_EQ(format_npy_header(NpyDtype::i1, shape).size() % 64, 0u);
    }
  }
}

TEST(NpyHeader, ReadsBackEveryDtypeAndShape) {
  for (const NpyDtype dtype :
       {NpyDtype::f4, NpyDtype::f8, NpyDtype::u4, NpyDtype::i8, NpyDtype::i1, NpyDtype::b1}) {
    for (const Shape& shape :
         {Shape{}, Shape{0}, Shape{7}, Shape{3, 6}, Shape{0, 6}, Shape{2, 3, 4}}) {
      std::uint64_t bytes = npy_item_size(dtype);
      for (const std::uint64_t extent : shape) bytes *= extent;
      const std::string header = format_npy_header(dtype, shape);
      const NpyHeader parsed = parse_npy_header(header + std::string(bytes, 'x'), "a");
      EXPECT_EQ(parsed.dtype, dtype);
      EXPECT_EQ(parsed.shape, shape);
      EXPECT_EQ(parsed.data_offset, header.size());
      EXPECT_EQ(parsed.data_bytes, bytes);
    }
  }
}

TEST(NpyHeader, ReadsVersions2And3AndOtherSpellings) {
  const std::string literal = "{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }\n";
  for (const int version : {1, 2, 3}) {
    EXPECT_EQ(parse_npy_header(npy_file(literal, 24, version), "a").shape, Shape{3}) << version;
  }
  for (const char* other :
       {"{\"shape\":(3L,),\"fortran_order\":False,\"descr\":\"<f8\"}",
        "{ 'fortran_order' : False , 'descr' : '<f8' , 'shape' : ( 3 , ) , } \n",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 1, )}"}) {
    EXPECT_EQ(refusal_of_literal(other), "accepted") << other;
  }
  EXPECT_EQ(parse_npy_header(npy_file("{'descr':'<b1','fortran_order':False,'shape':(2,)}", 2), "a")
                .dtype,
            NpyDtype::b1);
}

TEST(NpyHeader, SaysWhatWasGotForOtherTypesOrdersAndVersions) {
  EXPECT_EQ(refusal_of_literal("{'descr': '<i4', 'fortran_order': False, 'shape': (3,)}"),
            "rays.npy: byte 25: NPY dtype '<i4', expected one of '<f4', '<f8', '<u4', '<i8', "
            "'|i1', '|b1'");
  EXPECT_NE(refusal_of_literal("{'descr': '>f8', 'fortran_order': False, 'shape': (3,)}")
                .find("'>f8' (big-endian)"),
            std::string::npos);
  EXPECT_NE(refusal_of_literal("{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (3,)}")
                .find("records"),
            std::string::npos);
  EXPECT_EQ(refusal_of_literal("{'descr': '<f8', 'fortran_order': True, 'shape': (3, 1)}"),
            "rays.npy: NPY array of shape (3, 1) in Fortran order, expected C");
  EXPECT_EQ(refusal(npy_file("{}", 0, 4)), "rays.npy: NPY version 4.0, expected 1.0, 2.0 or 3.0");
}

TEST(NpyHeader, RefusesTooFewAndTooManyData) {
  const std::string literal = "{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }";
  EXPECT_EQ(refusal(npy_file(literal, 23)),
            "rays.npy: NPY array of dtype '<f8' and shape (3,) needs 24 bytes of data, got 23");
  EXPECT_NE(refusal(npy_file(literal, 25)), "accepted");
  EXPECT_EQ(refusal(npy_file(literal, 24)), "accepted");
}

TEST(NpyHeader, SaysWhenTheHeaderIsLongerThanTheFile) {
  EXPECT_EQ(refusal(std::string("\x93NUMPY\x02\x00\xff\xff\xff\xff{}", 14)),
            "rays.npy: NPY header of 4294967295 bytes in a file of 14");
}

TEST(NpyHeader, IsNotFooledByHugeShapes) {
  for (const char* shape :
       {"(18446744073709551615,)", "(4294967296, 4294967296)", "(4294967296, 536870912)",
        "(2305843009213693952, 1)", "(2305843009213693955, 1)", "(1000000000000000000000,)"}) {
    const std::string literal =
        std::string("{'descr': '<f8', 'fortran_order': False, 'shape': ") + shape + "}";
    EXPECT_NE(refusal_of_literal(literal), "accepted") << shape;
  }
  const std::string none =
      "{'descr': '<f8', 'fortran_order': False, 'shape': (0, 4294967296, "
      "4294967296)}";
  EXPECT_EQ(refusal(npy_file(none, 0)), "accepted");
}

TEST(NpyHeader, RefusesEveryMalformedDictionary) {
  for (const char* bad : {"",
                          " ",
                          "{",
                          "{}",
                          "[]",
                          "{'descr'}",
                          "{'descr': }",
                          "{'descr': '<f8'",
                          "{'descr': '<f8', 'fortran_order': False}",
                          "{'fortran_order': False, 'shape': (3,)}",
                          "{'descr': '<f8', 'shape': (3,)}",
                          "{'descr': '<f8' 'fortran_order': False, 'shape': (3,)}",
                          "{'descr': '<f8', 'fortran_order': false, 'shape': (3,)}",
                          "{'descr': '<f8', 'fortran_order': False, 'shape': (3)}",
                          "{'descr': '<f8', 'fortran_order': False, 'shape': 3}",
                          "{'descr': '<f8', 'fortran_order': False, 'shape': [3]}",
                          "{'descr': '<f8', 'fortran_order': False, 'shape': (-3,)}",
                          "{'descr': '<f8', 'fortran_order': False, 'shape': (3.0,)}",
                          "{'descr': '<f8', 'fortran_order': False, 'shape': (3 1)}",
                          "{'descr': '<f8', 'fortran_order': False, 'shape': (,)}",
                          "{'descr': '<f8', 'fortran_order': False, 'shape': (3,,)}",
                          "{'descr': '<f8', 'fortran_order': False, 'shape': (3,",
                          "{'descr': '<f8', 'descr': '<f8', 'fortran_order': False, 'shape': (3,)}",
                          "{'descr': '<f8', 'fortran_order': False, 'shape': (3,), 'more': 1}",
                          "{'descr': '<f8', 'fortran_order': False, 'shape': (3,)} x",
                          "{'descr': '<f8, 'fortran_order': False, 'shape': (3,)}",
                          "{'descr': '<f8\", 'fortran_order': False, 'shape': (3,)}",
                          "{'descr': '"}) {
    EXPECT_NE(refusal_of_literal(bad), "accepted") << bad;
  }
  std::string many = "{'descr': '<f8', 'fortran_order': False, 'shape': (3,";
  for (int i = 0; i < 32; ++i) many += "1,";
  EXPECT_NE(refusal_of_literal(many + ")}").find("32 dimensions"), std::string::npos);
}

TEST(NpyHeader, RefusesEveryTruncationOfAValidFile) {
  for (const int version : {1, 2}) {
    const std::string file =
        npy_file("{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }\n", 24, version);
    for (std::size_t length = 0; length < file.size(); ++length) {
      ASSERT_NE(refusal(file.substr(0, length)), "accepted") << length;
    }
    ASSERT_EQ(refusal(file), "accepted");
  }
}

TEST(NpyHeader, SurvivesEverySingleByteChange) {
  const std::string file =
      npy_file("{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }\n", 24);
  for (std::size_t i = 0; i < file.size() - 24; ++i) {
    for (int value = 0; value < 256; ++value) {
      std::string changed = file;
      changed[i] = static_cast<char>(value);
      const std::string result = refusal(changed);
      ASSERT_LT(result.size(), 300u);
    }
  }
}

}  // namespace
}  // namespace strahl
