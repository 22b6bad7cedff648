// io/stl_test.cpp - both forms of STL, how they are told apart, their errors.
#include <cmath>
#include <cstring>
#include <tests/support/memory_file.h>

#include <gtest/gtest.h>

#include <strahl/io/stl.h>

namespace strahl {
namespace {

using test::error_of;
using test::memory_file;

std::string binary(std::uint32_t count, std::size_t triangles, std::string start = "") {
  start.resize(80, '\0');
  start.append(reinterpret_cast<const char*>(&count), 4);
  for (std::size_t i = 0; i < triangles; ++i) {
    const float f = static_cast<float>(i);
    const float values[12] = {9, 9, 9, f, 0, 0, 1, f, 0, 0, 1, f};
    start.append(reinterpret_cast<const char*>(values), sizeof values);
    start.append("ab");
  }
  return start;
}

const std::string kFacet =
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 0.1 0\n"
    " endloop\nendfacet\n";

SceneData read(const std::string& text) { return read_stl(memory_file(text, "a.stl")); }
std::string error(const std::string& text) {
  return error_of([&] { read(text); });
}

TEST(Stl, ReadsBinaryInFileOrder) {
  const SceneData scene = read(binary(2, 2));
  const TriangleMesh& mesh = scene.geometries.at(0).mesh;
  ASSERT_EQ(mesh.size(), 2u);
  EXPECT_FALSE(mesh.vertices.is_double);
  EXPECT_EQ(mesh.vertices.count, 6u);
  EXPECT_EQ(mesh[1].a, (Vec3d{1, 0, 0}));
  EXPECT_EQ(mesh[1].b, (Vec3d{1, 1, 0}));
  EXPECT_EQ(mesh[1].c, (Vec3d{0, 1, 1}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Stl, ReadsAsciiAsFloat64) {
  const SceneData scene = read("solid a b\n" + kFacet + "endsolid a b\n");
  const TriangleMesh& mesh = scene.geometries.at(0).mesh;
  ASSERT_EQ(mesh.size(), 1u);
  EXPECT_EQ(mesh[0].c, (Vec3d{0, 0.1, 0}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Stl, TheSizeTellsBinaryWhateverTheHeaderSays) {
  EXPECT_EQ(read(binary(1, 1, "solid facet normal")).geometries.at(0).size(), 1u);
  EXPECT_EQ(read(binary(1, 1, "solid") + "tail").geometries.at(0).size(), 1u);
}

TEST(Stl, WarnsOfBytesBehindTheTriangles) {
  EXPECT_EQ(read(binary(1, 1) + "tail").warnings,
            std::vector<std::string>{"byte 134: 4 bytes after the triangles"});
}

TEST(Stl, ReadsSeveralSolidsMixedCaseAndAMissingEndsolid) {
  std::string upper = kFacet;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  const std::string text = " Solid a\r\n" + kFacet + "EndSolid\nSOLID b\n" + upper + "endsolid\n" +
                           "solid c\nendsolid c\nsolid d\n" + kFacet;
  EXPECT_EQ(read(text).geometries.at(0).size(), 3u);
}

TEST(Stl, WellFormedFilesWithoutTrianglesAreEmptyWithAWarning) {
  for (const std::string& text :
       {binary(0, 0), std::string("solid a\nendsolid a"), std::string("solid")}) {
    const SceneData scene = read(text);
    EXPECT_TRUE(scene.geometries.empty());
    EXPECT_EQ(scene.warnings, std::vector<std::string>{"no triangles"});
  }
}

TEST(Stl, NotFiniteVerticesAreKept) {
  std::string text = kFacet;
  text.replace(text.find("1 0 0"), 1, "nan");
  EXPECT_TRUE(std::isnan(read("solid\n" + text).geometries.at(0).mesh[0].b.x));
}

TEST(Stl, TooFewBytesForTheCountAreAnErrorBeforeAnythingIsReserved) {
  EXPECT_EQ(error(binary(4294967295u, 2)),
            "a.stl: byte 80: 4294967295 triangles need 214748364834 bytes, the file has 184");
  EXPECT_EQ(error(binary(2, 2).substr(0, 183)),
            "a.stl: byte 80: 2 triangles need 184 bytes, the file has 183");
  EXPECT_EQ(error(""), "a.stl: byte 0: neither ascii nor long enough for binary STL");
  EXPECT_EQ(error("solidify"), "a.stl: byte 8: neither ascii nor long enough for binary STL");
}

TEST(Stl, AsciiErrorsNameTheLine) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = "solid\n" + kFacet;
    text.replace(text.find(from), from.size(), to);
    return error(text);
  };
  EXPECT_EQ(with("  vertex 1 0 0\n", ""), "a.stl: line 7: facet with 2 vertices instead of 3");
  EXPECT_EQ(with("vertex 1 0 0\n", "vertex 1 0 0\nvertex 1 0 0\n"),
            "a.stl: line 7: facet with more than 3 vertices");
  EXPECT_EQ(with("vertex 1 0 0", "vertex 1 0"), "a.stl: line 5: missing z");
  EXPECT_EQ(with("vertex 1 0 0", "vertex 1 0 0 0"), "a.stl: line 5: unexpected '0'");
  EXPECT_EQ(with("vertex 1 0 0", "vertex 1 O 0"), "a.stl: line 5: y is not a number: 'O'");
  EXPECT_EQ(with("vertex 1 0 0", "vertx 1 0 0"), "a.stl: line 5: unknown keyword 'vertx'");
  EXPECT_EQ(with("endfacet\n", ""), "a.stl: line 8: the file ends inside a facet");
  EXPECT_EQ(with("endfacet", "facet"), "a.stl: line 8: facet inside a facet");
  EXPECT_EQ(with("endfacet", "endsolid"), "a.stl: line 8: endsolid inside a facet");
  EXPECT_EQ(error("solid\nvertex 0 0 0\n"), "a.stl: line 2: vertex outside a facet");
  EXPECT_EQ(error("solid\nendfacet\n"), "a.stl: line 2: endfacet without facet");
}

}  // namespace
}  // namespace strahl
