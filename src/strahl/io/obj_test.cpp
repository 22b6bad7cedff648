// io/obj_test.cpp - OBJ statements, their errors and the shared OBJ files.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>
#include <string>
#include <tests/support/shared.h>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/io/obj.h>

namespace strahl {
namespace {

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

FileBytes bytes_of(const std::string& text) {
  return {std::as_bytes(std::span(text.data(), text.size())), "test.obj", {}, nullptr};
}

SceneData read(const std::string& text) { return read_obj(bytes_of(text)); }

std::size_t triangles(const SceneData& scene) {
  return scene.geometries.empty() ? 0 : scene.geometries.front().mesh.size();
}

std::vector<std::uint64_t> indices(const SceneData& scene) {
  std::vector<std::uint64_t> all;
  const IndexView& view = scene.geometries.at(0).mesh.triangles;
  for (std::size_t i = 0; i < view.count; ++i) {
    for (const std::uint64_t index : {view[i].a, view[i].b, view[i].c}) all.push_back(index);
  }
  return all;
}

// The text of the error of reading `text`; empty if there is none.
std::string error_of(const std::string& text) {
  try {
    read(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    return error.what();
  }
  return "";
}

bool warns(const SceneData& scene, const std::string& words) {
  for (const std::string& warning : scene.warnings) {
    if (warning.find(words) != std::string::npos) return true;
  }
  return false;
}

TEST(Obj, ReadsATriangleInDoublePrecision) {
  const SceneData scene = read("v 0.1 -2.5e-3 +1e5\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  ASSERT_EQ(triangles(scene), 1U);
  const Geometry& geometry = scene.geometries[0];
  EXPECT_EQ(geometry.geometry_id, 0U);
  EXPECT_TRUE(geometry.mesh.vertices.is_double);
  EXPECT_EQ(geometry.mesh[0].a, (Vec3d{0.1, -2.5e-3, 1e5}));
  EXPECT_TRUE(geometry.face_ids.empty());
  EXPECT_TRUE(geometry.materials.empty());
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.source, "test.obj");
}

TEST(Obj, TakesTheVertexOfEveryFormOfCorner) {
  const SceneData scene = read(kTriangle + "f 1/9 2//8 3/7/6\nf 3// 2/ 1/x/y\n");
  EXPECT_EQ(indices(scene), (std::vector<std::uint64_t>{0, 1, 2, 2, 1, 0}));
}

TEST(Obj, NegativeIndicesCountBackFromTheLastVertexRead) {
  const SceneData scene = read(kTriangle + "f -3 -2 -1\nv 5 5 5\nf -3 -2 -1\n");
  EXPECT_EQ(indices(scene), (std::vector<std::uint64_t>{0, 1, 2, 1, 2, 3}));
}

TEST(Obj, FacesMayComeBeforeTheirVertices) {
  EXPECT_EQ(indices(read("f 3 2 1\n" + kTriangle)), (std::vector<std::uint64_t>{2, 1, 0}));
}

TEST(Obj, PolygonsBecomeTrianglesThatNameTheirFace) {
  const SceneData scene =
      read(kTriangle + "v 1 1 0\nf 1 2 3\nf 1 2 4 3\nf 1 2\nf 1 2 3\nf 1 1 2\n");
  ASSERT_EQ(triangles(scene), 5U);
  EXPECT_EQ(scene.geometries[0].face_ids, (std::vector<std::uint32_t>{0, 1, 1, 3, 4}));
  EXPECT_TRUE(warns(scene, "1 faces with fewer than 3 vertices"));
}

TEST(Obj, LinesMayEndInAnyWayAndBeContinued) {
  for (const std::string end : {"\n", "\r", "\r\n"}) {
    const std::string text = "# x \\" + end + "v 0 0 0" + end + "v 1 0 0 1.0" + end +
                             "v\t0 1 0 .5 nan .5" + end + end + "f 1 2 \\" + end + " 3";
    EXPECT_EQ(triangles(read(text)), 1U) << triangles(read(text));
  }
}

TEST(Obj, OtherStatementsAreIgnored) {
  const SceneData scene =
      read("o a f b\ng f 1 2 3\nvn 1 2\nvt x\ns off\nl 1 2\np 1\nfoo \\\n f 1 2 9\n" + kTriangle +
           "f 1 2 3 # f 1\n");
  EXPECT_EQ(triangles(scene), 1U);
}

TEST(Obj, WithoutFacesThereIsNoGeometryButAWarning) {
  for (const std::string text : {"", "# nothing\n", "v 1 2 3\n", "v 1 2 3\nl 1 1\n"}) {
    const SceneData scene = read(text);
    EXPECT_TRUE(scene.geometries.empty());
    EXPECT_TRUE(warns(scene, "no triangles"));
  }
}

TEST(Obj, NumbersAreReadAsTheirValidBeginningWithAWarning) {
  const SceneData scene = read("v 3.1+e2 1e 2x\nv 1.#INF 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(scene.geometries[0].mesh.vertices[0], (Vec3d{3.1, 1, 2}));
  EXPECT_FALSE(is_finite(scene.geometries[0].mesh.vertices[1]));
  EXPECT_TRUE(warns(scene, "line 1: coordinate '3.1+e2' read as '3.1' (and 3 more"));
  EXPECT_EQ(error_of("v 0 0 0\nv 0 abc 0\n"),
            "test.obj: line 2: coordinate is not a number: 'abc'");
  EXPECT_EQ(error_of("v 0 0 infra\n"), "test.obj: line 1: coordinate is not a number: 'infra'");
  EXPECT_EQ(error_of("v 0 0\n"), "test.obj: line 1: missing coordinate");
}

TEST(Obj, NotFiniteCoordinatesAreKept) {
  const SceneData scene = read("v nan -inf 1e400\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Vec3d vertex = scene.geometries[0].mesh.vertices[0];
  EXPECT_TRUE(std::isnan(vertex.x));
  EXPECT_EQ(vertex.y, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(vertex.z, std::numeric_limits<double>::infinity());
}

TEST(Obj, WrongIndicesAreErrorsWithTheirLine) {
  EXPECT_EQ(error_of(kTriangle + "f 0 1 2\n"),
            "test.obj: line 4: vertex index 0; indices start at 1");
  EXPECT_EQ(error_of(kTriangle + "f 1 2 4\n\n"),
            "test.obj: line 4: vertex index 4 out of range, 3 vertices in the file");
  EXPECT_EQ(error_of(kTriangle + "f 1 2 -4\nv 1 1 1\n"),
            "test.obj: line 4: vertex index -4 out of range, 3 vertices so far");
  EXPECT_NE(error_of(kTriangle + "f 1 2 99999999999999999999\n").find("line 4"), std::string::npos);
  EXPECT_NE(error_of(kTriangle + "f 1 2 4294967297\n").find("line 4"), std::string::npos);
  EXPECT_NE(error_of(kTriangle + "f 1 2 3.0\n").find("line 4"), std::string::npos);
  EXPECT_NE(error_of(kTriangle + "f 1 2 /3\n").find("line 4"), std::string::npos);
}

TEST(Obj, WhatIsNotObjTextIsAnError) {
  EXPECT_NE(error_of("\nhello world\nf1 2 3\n").find("line 2: no OBJ statement"),
            std::string::npos);
  EXPECT_NE(error_of(kTriangle + std::string("f 1 2 3\0", 8)).find("byte 31: NUL"),
            std::string::npos);
  EXPECT_NE(error_of("\xFE\xFF v").find("UTF-16"), std::string::npos);
}

class ObjMaterials : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        std::filesystem::path(testing::TempDir()) / (std::string("strahl_obj_") + test->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  SceneData read_text(const std::string& text) const {
    write("scene.obj", text);
    return read_obj(map_file(folder_ / "scene.obj"));
  }

  std::filesystem::path folder_;
};

TEST_F(ObjMaterials, AreTheDefaultOneAndThoseUsed) {
  write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl unused\nKd .1 .1 .1\nnewmtl big name\nKd 0 0 1\n");
  const SceneData scene = read_text("mtllib a.mtl\n" + kTriangle +
                                    "v 1 1 0\nf 1 2 3\nusemtl big name\nf 1 2 4 3\n"
                                    "usemtl red\nf 1 2 3\nusemtl\nf 1 2 3\n");
  ASSERT_EQ(scene.materials.size(), 3U);
  EXPECT_EQ(scene.materials[0].color, Material{}.color);
  EXPECT_EQ(scene.materials[1].color, (Vec3d{0, 0, 1}));
  EXPECT_EQ(scene.materials[2].color, (Vec3d{1, 0, 0}));
  EXPECT_EQ(scene.geometries[0].materials, (std::vector<std::uint32_t>{0, 1, 1, 2, 0}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(ObjMaterials, MayBeInSeveralLibrariesAndTheFirstDefinitionCounts) {
  write("z.mtl", "newmtl red\nKd 1 0 0\n");
  write("a b.mtl", "newmtl blue\nKd 0 0 1\nnewmtl red\nKd .5 0 0\n");
  write("c.mtl", "newmtl green\nKd 0 1 0\n");
  const SceneData scene = read_text("mtllib z.mtl c.mtl\nmtllib a b.mtl\n" + kTriangle +
                                    "usemtl red\nf 1 2 3\nusemtl green\nf 1 2 3\n"
                                    "usemtl blue\nf 1 2 3\n");
  ASSERT_EQ(scene.materials.size(), 4U);
  EXPECT_EQ(scene.materials[1].color, (Vec3d{1, 0, 0}));
  EXPECT_EQ(scene.materials[2].color, (Vec3d{0, 1, 0}));
  EXPECT_EQ(scene.materials[3].color, (Vec3d{0, 0, 1}));
}

TEST_F(ObjMaterials, ThatAreMissingOrMalformedOnlyWarn) {
  write("bad.mtl", "newmtl red\nKd 1 zero 0\n");
  const SceneData scene = read_text("mtllib none.mtl\nmtllib bad.mtl\n" + kTriangle +
                                    "usemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\n");
  EXPECT_EQ(triangles(scene), 2U);
  EXPECT_TRUE(scene.materials.empty());
  EXPECT_TRUE(scene.geometries[0].materials.empty());
  EXPECT_TRUE(warns(scene, "line 1: material library 'none.mtl' not read"));
  EXPECT_TRUE(warns(scene, "(and 1 more like it)"));
  EXPECT_TRUE(warns(scene, "line 6: material 'red' is not defined"));
}

struct SharedFile {
  const char* name;
  std::size_t triangles;
};

TEST(Obj, TheSharedScenesHaveTheirPublishedTriangleCounts) {
  STRAHL_REQUIRE_SHARED("scenes");
  // wallhole: 66 triangles once the repeated vertices of the file are merged, 11 of them
  // degenerate.
  for (const SharedFile file : {SharedFile{"cornell_box.obj", 36}, SharedFile{"spot.obj", 5856},
                                SharedFile{"suzanne.obj", 968}, SharedFile{"teapot.obj", 6320},
                                SharedFile{"wallhole.obj", 66}}) {
    EXPECT_EQ(triangles(read_obj(map_file(test::shared_dir() / "scenes" / file.name))),
              file.triangles)
        << file.name;
  }
}

TEST(Obj, TheCornellBoxHasItsColours) {
  STRAHL_REQUIRE_SHARED("scenes/cornell_box.mtl");
  const SceneData scene = read_obj(map_file(test::shared_dir() / "scenes" / "cornell_box.obj"));
  EXPECT_EQ(scene.materials.size(), 6U);
  EXPECT_EQ(scene.geometries[0].materials.size(), 36U);
}

}  // namespace
}  // namespace strahl
