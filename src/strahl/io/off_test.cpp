// io/off_test.cpp - OFF with its variants, and its errors.
#include <tests/support/memory_file.h>
#include <tests/support/shared.h>

#include <gtest/gtest.h>

#include <strahl/io/off.h>

namespace strahl {
namespace {

using test::error_of;
using test::memory_file;

const std::string kSquare = "0 0 0\n1 0 0\n1 1 0\n0 0.1 0\n";

SceneData read(const std::string& text) { return read_off(memory_file(text, "a.off")); }
std::string error(const std::string& text) {
  return error_of([&] { read(text); });
}

TEST(Off, ReadsTrianglesAndPolygons) {
  const SceneData scene = read("OFF\n4 3 0\n" + kSquare + "3 0 1 2\n4 0 1 2 3\n2 0 1\n");
  ASSERT_EQ(scene.geometries.size(), 1u);
  const Geometry& geometry = scene.geometries[0];
  ASSERT_EQ(geometry.size(), 3u);
  EXPECT_EQ(geometry.face_ids, (std::vector<std::uint32_t>{0, 1, 1}));
  EXPECT_EQ(geometry.mesh[2].c, (Vec3d{0, 0.1, 0}));
  EXPECT_EQ(scene.warnings, std::vector<std::string>{"1 faces with fewer than 3 vertices skipped"});
}

TEST(Off, CountsMayFollowTheKeywordAndEdgesMayLack) {
  for (const std::string start :
       {"OFF 4 1 0\n", "OFF\n\n4 1\n", "OFF4 1 0\n", "OFF # c\n# c\n4 1 0 # c\n"})
    EXPECT_EQ(read(start + kSquare + "3 0 1 2\n").geometries.at(0).size(), 1u) << start;
}

TEST(Off, IgnoresColoursNormalsAndComments) {
  for (const std::string keyword : {"OFF", "COFF", "NOFF", "CNOFF", "STCNOFF", "STOFF"}) {
    const SceneData scene = read(keyword + "\n3 2 0\n# corners\n0 0 0 255 0 0 255\n1 0 0 1 1 1\n" +
                                 "0 1 0 # last\n\n3 0 1 2 0.5 0.5 0.5\n3 2 1 0 7\n");
    EXPECT_EQ(scene.geometries.at(0).size(), 2u) << keyword;
    EXPECT_TRUE(scene.geometries[0].face_ids.empty());
    EXPECT_TRUE(scene.warnings.empty());
  }
}

TEST(Off, WellFormedFilesWithoutFacesAreEmptyWithAWarning) {
  for (const std::string& text : {std::string("OFF\n0 0 0\n"), "OFF\n4 0 0\n" + kSquare}) {
    const SceneData scene = read(text);
    EXPECT_TRUE(scene.geometries.empty());
    EXPECT_EQ(scene.warnings, std::vector<std::string>{"no triangles"});
  }
}

TEST(Off, ErrorsNameTheLine) {
  EXPECT_EQ(error(""), "a.off: line 1: no OFF file: it starts with ''");
  EXPECT_EQ(error("4OFF\n"), "a.off: line 1: no OFF file: it starts with '4OFF'");
  EXPECT_EQ(error("OFF BINARY\n"), "a.off: line 1: binary OFF is not supported");
  EXPECT_EQ(error("OFF\n0\n"), "a.off: line 2: missing face count");
  EXPECT_EQ(error("OFF\n-1 0 0\n"), "a.off: line 2: -1: vertex count does not fit the file");
  EXPECT_EQ(error("OFF\n1000000000 1 0\n0 0 0\n"),
            "a.off: line 2: 1000000000: vertex count does not fit the file");
  EXPECT_EQ(error("OFF\n1 1 0\n0 0\n3 0 0 0\n"), "a.off: line 3: missing z");
  EXPECT_EQ(error("OFF\n1 1 0\n0 0 x\n3 0 0 0\n"), "a.off: line 3: z is not a number: 'x'");
  EXPECT_EQ(error("OFF\n4 1 0\n" + kSquare + "3 0 1 4\n"),
            "a.off: line 7: vertex index 4 of 4 vertices");
  EXPECT_EQ(error("OFF\n4 1 0\n" + kSquare + "3 0 1 -1\n"),
            "a.off: line 7: vertex index -1 of 4 vertices");
  EXPECT_EQ(error("OFF\n4 1 0\n" + kSquare + "3 0 1\n"), "a.off: line 8: missing vertex index");
  EXPECT_EQ(error("OFF\n4 1 0\n" + kSquare + "99 0 1 2\n"),
            "a.off: line 7: 99: corner count does not fit the file");
  EXPECT_EQ(error("OFF\n4 2 0\n" + kSquare + "3 0 1 2\n"),
            "a.off: line 8: the file ends inside the faces");
  EXPECT_EQ(error("OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0          \n"),
            "a.off: line 6: the file ends inside the vertices");
}

TEST(Off, ReadsARealMesh) {
  STRAHL_REQUIRE_SHARED("reference/trimesh_rays/ballA.off");
  const SceneData scene =
      read_off(map_file(test::shared_dir() / "reference/trimesh_rays/ballA.off"));
  EXPECT_EQ(scene.geometries.at(0).size(), 3796u);
  EXPECT_EQ(scene.geometries[0].mesh.vertices[0], (Vec3d{-0.25829, -4.29578, 4.02524}));
  EXPECT_TRUE(scene.warnings.empty());
}

}  // namespace
}  // namespace strahl
