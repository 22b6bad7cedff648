// io/gltf_document_test.cpp - the container, its JSON, buffers inside and beside the file.
#include <filesystem>
#include <fstream>
#include <tests/support/gltf_file.h>

#include <gtest/gtest.h>

#include <strahl/io/gltf_buffers.h>

namespace strahl {
namespace {

using nlohmann::json;
using test::append_u32;
using test::GltfFile;
using test::make_glb;
using test::memory_file;
using test::one_triangle;

std::string error(const std::string& bytes) {
  return test::error_of([&] { read_gltf(memory_file(bytes, "a")); });
}

void put_u32(std::string& bytes, std::size_t at, std::uint32_t value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

TEST(GltfDocument, RefusesAContainerThatIsCutOffOrLies) {
  const std::string good = make_glb(R"({"asset":{"version":"2.0"}})", "");
  EXPECT_EQ(error(good), "no error");
  EXPECT_EQ(error(good.substr(0, 11)), "a: byte 11: GLB: header cut off");
  std::string bad = good;
  put_u32(bad, 4, 1);
  EXPECT_EQ(error(bad), "a: byte 4: GLB: version 1, only 2 is supported");
  bad = good;
  put_u32(bad, 8, 1000);
  EXPECT_EQ(error(bad), "a: byte 8: GLB: length 1000 in a file of 56 bytes");
  bad = good;
  put_u32(bad, 12, 0xFFFFFFFF);
  EXPECT_EQ(error(bad), "a: byte 12: GLB: chunk of 4294967295 bytes reaches past the end");
  bad = good;
  put_u32(bad, 16, 0x004E4942);
  EXPECT_EQ(error(bad), "a: byte 16: GLB: the first chunk is not JSON");
  bad = good;
  put_u32(bad, 8, 12);
  EXPECT_EQ(error(bad), "a: byte 12: GLB: no JSON chunk");
  bad = good;
  put_u32(bad, 8, 52);
  EXPECT_EQ(error(bad), "a: byte 48: GLB: chunk header cut off");
}

TEST(GltfDocument, EveryPrefixOfAFileIsAnErrorOrAScene) {
  GltfFile file = one_triangle();
  file.root["nodes"] = {{{"mesh", 0}}};
  const std::string glb = file.glb(), text = file.text();
  EXPECT_EQ(error(glb), "no error");
  EXPECT_EQ(error(text), "no error");
  for (std::size_t n = 0; n < glb.size(); ++n) EXPECT_NE(error(glb.substr(0, n)), "no error") << n;
  for (std::size_t n = 0; n < text.size(); ++n)
    EXPECT_NE(error(text.substr(0, n)), "no error") << n;
}

TEST(GltfDocument, CitesTheByteOfASyntaxError) {
  EXPECT_EQ(error(R"({"asset":})").substr(0, 21), "a: byte 10: not JSON:");
  EXPECT_EQ(error(make_glb(R"({"asset":})", "")).substr(0, 21), "a: byte 30: not JSON:");
  EXPECT_NE(error("").find("not JSON"), std::string::npos);
  EXPECT_NE(error(R"({"asset":1e999})").find("not usable JSON"), std::string::npos);
}

TEST(GltfDocument, LimitsNesting) {
  const auto nested = [](std::size_t depth) {
    return R"({"asset":{"version":"2.0"},"extras":)" + std::string(depth, '[') +
           std::string(depth, ']') + "}";
  };
  EXPECT_EQ(error(nested(200)), "no error");
  EXPECT_EQ(error(nested(300)), "a: byte 291: JSON nested deeper than 256 levels");
  EXPECT_NE(error(nested(1'000'000)).find("nested deeper"), std::string::npos);
  // Brackets in strings do not nest, whatever the quotes around them.
  EXPECT_EQ(error(R"({"asset":{"version":"2.0"},"extras":"\")" + std::string(300, '[') + "\"}"),
            "no error");
}

TEST(GltfDocument, ReadsVersionTwoOnly) {
  EXPECT_EQ(error("{}"), "a: /: 'asset' is missing");
  EXPECT_EQ(error(R"({"asset":{"version":"1.0"}})"),
            "a: /asset/version: version '1.0', only 2.0 is supported");
  EXPECT_EQ(error(R"({"asset":{"version":"2.1"}})"), "no error");
  EXPECT_EQ(error(R"({"asset":{"version":"2.1","minVersion":"2.1"}})"),
            "a: /asset/minVersion: version '2.1', only 2.0 is supported");
}

TEST(GltfDocument, NamesARequiredExtensionItLacks) {
  const auto requiring = [](const std::string& name) {
    return R"({"asset":{"version":"2.0"},"extensionsRequired":[")" + name + "\"]}";
  };
  EXPECT_EQ(error(requiring("KHR_draco_mesh_compression")),
            "a: /extensionsRequired/0: requires the extension KHR_draco_mesh_compression, which is "
            "not supported");
  EXPECT_NE(error(requiring("EXT_meshopt_compression")).find("EXT_meshopt_compression"),
            std::string::npos);
  EXPECT_EQ(error(requiring("KHR_mesh_quantization")), "no error");
  EXPECT_EQ(error(requiring("KHR_materials_unlit")), "no error");
}

TEST(GltfDocument, NeverRepeatsRawBytesOfTheFileInAMessage) {
  const std::string message = error("{\"asset\": \x01\xFF\xFE");
  for (const char c : message) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << message;
  EXPECT_LT(error(R"({"asset":{"version":")" + std::string(100'000, 'x') + "\"}}").size(), 300u);
}

TEST(GltfBuffers, DecodesBase64Strictly) {
  const auto decoded = [](std::string_view text) -> std::string {
    const auto bytes = gltf::decode_base64(text);
    if (!bytes) return "malformed";
    return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
  };
  EXPECT_EQ(decoded(""), "");
  EXPECT_EQ(decoded("Zg=="), "f");
  EXPECT_EQ(decoded("Zm8="), "fo");
  EXPECT_EQ(decoded("Zm9v"), "foo");
  EXPECT_EQ(decoded("+/+/"), "\xFB\xFF\xBF");
  for (const char* bad : {"Zg=", "Zg", "Z===", "====", "Zm9v\n", "Zm=v", "Zm9-", "Zm 9"})
    EXPECT_EQ(decoded(bad), "malformed") << bad;
  std::string all;
  for (int c = 0; c < 256; ++c) all += static_cast<char>(c);
  EXPECT_EQ(decoded(test::base64(all)), all);
}

class GltfSiblings : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) / "strahl_gltf_siblings";
    std::filesystem::create_directories(folder_ / "in" / "sub");
    file_ = one_triangle();
    file_.root["nodes"] = {{{"mesh", 0}}};
    for (const char* name : {"in/my part.bin", "in/sub/part.bin", "outside.bin"})
      std::ofstream(folder_ / name, std::ios::binary) << file_.bin;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string outcome(const std::string& uri, std::size_t stated = 36) {
    file_.root["buffers"] = {{{"byteLength", stated}, {"uri", uri}}};
    FileBytes bytes = memory_file(file_.root.dump(), "a");
    bytes.folder = folder_ / "in";
    return test::error_of(
        [&] { EXPECT_EQ(read_gltf(bytes).geometries.at(0).mesh[0].b, Vec3d(1, 0, 0)); });
  }

  std::filesystem::path folder_;
  GltfFile file_;
};

TEST_F(GltfSiblings, AreReadFromTheFolderAndBelow) {
  EXPECT_EQ(outcome("my%20part.bin"), "no error");
  EXPECT_EQ(outcome("sub/part.bin"), "no error");
  EXPECT_EQ(outcome("sub/../sub/./part.bin"), "no error");
}

TEST_F(GltfSiblings, AreNotReadFromElsewhere) {
  const auto is_refused = [&](const std::string& uri) {
    return outcome(uri).find("is not inside the folder") != std::string::npos;
  };
  EXPECT_TRUE(is_refused("../outside.bin"));
  EXPECT_TRUE(is_refused("sub/../../outside.bin"));
  EXPECT_TRUE(is_refused("%2e%2E/outside.bin"));
  EXPECT_TRUE(is_refused((folder_ / "outside.bin").string()));
  EXPECT_TRUE(is_refused(""));
  EXPECT_NE(outcome("http://example.com/a.bin").find("is not a file name"), std::string::npos);
  EXPECT_NE(outcome("part.bin%00").find("is not a file name"), std::string::npos);
  EXPECT_NE(outcome("part%2").find("malformed percent-encoding"), std::string::npos);
}

TEST_F(GltfSiblings, AreNamedWhenMissingOrTooShort) {
  EXPECT_EQ(outcome("none.bin").find("a: /buffers/0/uri: file 'none.bin': "), 0u);
  EXPECT_EQ(outcome("sub").find("a: /buffers/0/uri: file 'sub': "), 0u);
  EXPECT_EQ(outcome("sub/part.bin", 37), "a: /buffers/0: holds 36 bytes, not the stated 37");
}

TEST(GltfBuffers, ReportsUnusableUris) {
  const auto with_buffer = [](json buffer) {
    GltfFile file = one_triangle();
    file.root["nodes"] = {{{"mesh", 0}}};
    buffer["byteLength"] = 36;
    file.root["buffers"] = {buffer};
    return error(file.root.dump());
  };
  EXPECT_EQ(with_buffer({{"uri", "data:;base64,AAA"}}), "a: /buffers/0/uri: malformed base64");
  EXPECT_EQ(with_buffer({{"uri", "data:,AAA"}}), "a: /buffers/0/uri: data URI without ';base64,'");
  EXPECT_EQ(with_buffer(json::object()), "a: /buffers/0: has no uri, and there is no BIN chunk");
  EXPECT_EQ(with_buffer({{"uri", "a.bin"}}),
            "a: /buffers/0/uri: refers to the file 'a.bin', but no folder is known");
  EXPECT_EQ(with_buffer({{"uri", 7}}), "a: /buffers/0/uri: must be a string, not number");
}

}  // namespace
}  // namespace strahl
