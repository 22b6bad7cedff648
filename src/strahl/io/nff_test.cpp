// io/nff_test.cpp - NFF statements, their errors and the shared NFF files.
#include <cmath>
#include <span>
#include <string>
#include <tests/support/shared.h>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/io/nff.h>

namespace strahl {
namespace {

SceneData read(const std::string& text) {
  return read_nff({std::as_bytes(std::span(text.data(), text.size())), "test.nff", {}, nullptr});
}

std::string error_of(const std::string& text) {
  try {
    read(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    return error.what();
  }
  return "";
}

const std::string kView =
    "v\nfrom 2.1 1.3 1.7\nat 0 0 1\nup 0 1 0\nangle 45\nhither 0.01\nresolution 512 256\n";

TEST(Nff, ReadsViewLightsAndBackground) {
  const SceneData scene = read("b 0.078 0.361 0.753\n" + kView + "l 4 3 2\nl 1 -4 4 1 .5 .5 # x\n");
  ASSERT_TRUE(scene.view.has_value());
  EXPECT_EQ(scene.view->from, (Vec3d{2.1, 1.3, 1.7}));
  EXPECT_EQ(scene.view->at, (Vec3d{0, 0, 1}));
  EXPECT_EQ(scene.view->up, (Vec3d{0, 1, 0}));
  EXPECT_EQ(scene.view->fov_degrees, 45.0);
  EXPECT_EQ(scene.view->width, 512);
  EXPECT_EQ(scene.view->height, 256);
  EXPECT_EQ(scene.background, (Vec3d{0.078, 0.361, 0.753}));
  EXPECT_EQ(scene.lights, (std::vector<Vec3d>{{4, 3, 2}, {1, -4, 4}}));
  EXPECT_EQ(scene.warnings, (std::vector<std::string>{"no primitives"}));
}

TEST(Nff, GeometriesHaveFixedIdsAndOnlyExistWithPrimitives) {
  const SceneData all = read("c 0 0 0 1 0 0 2 .5\ns 1 2 3 4\np 3\n0 0 0 1 0 0 0 1 0\n");
  ASSERT_EQ(all.geometries.size(), 3U);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(all.geometries[i].geometry_id, i);
  EXPECT_EQ(all.geometries[0].kind, PrimitiveKind::triangle);
  EXPECT_EQ(all.geometries[1].kind, PrimitiveKind::sphere);
  EXPECT_EQ(all.geometries[2].kind, PrimitiveKind::cone);
  const SceneData cones = read("c\n0 0 0 1\n0 0 2 .5\n");
  ASSERT_EQ(cones.geometries.size(), 1U);
  EXPECT_EQ(cones.geometries[0].geometry_id, 2U);
}

TEST(Nff, ReadsEveryNumberOfSpheresAndCones) {
  const SceneData scene = read("s 1 2 3 4\nc 1 2 3 4 5 6 7 8\n");
  const Sphere& sphere = scene.geometries[0].spheres.at(0);
  EXPECT_EQ(sphere.center, (Vec3d{1, 2, 3}));
  EXPECT_EQ(sphere.radius, 4.0);
  const Cone& cone = scene.geometries[1].cones.at(0);
  EXPECT_EQ(cone.base, (Vec3d{1, 2, 3}));
  EXPECT_EQ(cone.base_radius, 4.0);
  EXPECT_EQ(cone.apex, (Vec3d{5, 6, 7}));
  EXPECT_EQ(cone.apex_radius, 8.0);
}

TEST(Nff, PolygonsBecomeTrianglesThatNameTheirPolygon) {
  const SceneData scene = read(
      "p 3\n0 0 0\n1 0 0\n0 1 0\n"
      "p 4\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
      "p 2\n0 0 0\n1 1 1\n"
      "pp 3\n0 0 2 9 9 9\n1 0 2 9 9 9\n0 1 2 9 9 9\n");
  const Geometry& geometry = scene.geometries.at(0);
  ASSERT_EQ(geometry.size(), 4U);
  EXPECT_EQ(geometry.face_ids, (std::vector<std::uint32_t>{0, 1, 1, 3}));
  EXPECT_EQ(geometry.mesh[2].b, (Vec3d{1, 1, 1}));
  EXPECT_EQ(geometry.mesh[3].c, (Vec3d{0, 1, 2}));
  EXPECT_EQ(scene.warnings.size(), 1U);
}

TEST(Nff, EveryPrimitiveHasTheMaterialBeforeIt) {
  const SceneData scene = read(
      "f 1 .5 .25 .8 .1 3 .2 1.5\ns 0 0 0 1\np 4\n0 0 0 1 0 0 1 1 0 0 1 0\n"
      "f 0 0 1 1 0 0 0 1\ns 0 0 0 2\nc 0 0 0 1 0 0 1 1\n");
  ASSERT_EQ(scene.materials.size(), 2U);
  const Material& first = scene.materials[0];
  EXPECT_EQ(first.color, (Vec3d{1, .5, .25}));
  EXPECT_EQ(first.diffuse, .8);
  EXPECT_EQ(first.specular, .1);
  EXPECT_EQ(first.shine, 3.0);
  EXPECT_EQ(first.transmission, .2);
  EXPECT_EQ(first.refraction_index, 1.5);
  EXPECT_EQ(scene.geometries[0].materials, (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(scene.geometries[1].materials, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(scene.geometries[2].materials, (std::vector<std::uint32_t>{1}));
}

TEST(Nff, PrimitivesBeforeTheFirstMaterialHaveTheDefaultOne) {
  const SceneData scene = read("s 0 0 0 1\nf 0 0 1 1 0 0 0 1\ns 0 0 0 2\n");
  ASSERT_EQ(scene.materials.size(), 2U);
  EXPECT_EQ(scene.materials[0].color, Material{}.color);
  EXPECT_EQ(scene.geometries[0].materials, (std::vector<std::uint32_t>{0, 1}));
}

TEST(Nff, CommentsAndBlankLinesAreSkipped) {
  EXPECT_EQ(read("# s 1 1 1 1\n\n  s 0 0 0 # radius\n 2\r\n").geometries.at(0).size(), 1U);
}

TEST(Nff, NotFinitePrimitivesAreKept) {
  const SceneData scene = read("s nan 0 0 1\ns 0 0 0 1e400\n");
  EXPECT_TRUE(std::isnan(scene.geometries[0].spheres[0].center.x));
  EXPECT_TRUE(std::isinf(scene.geometries[0].spheres[1].radius));
}

TEST(Nff, ErrorsNameTheLine) {
  EXPECT_EQ(error_of("s 0 0 0 1\nq 1\n"), "test.nff: line 2: unknown statement 'q'");
  EXPECT_EQ(error_of("s 0 0 0\n"), "test.nff: line 2: missing radius");
  EXPECT_EQ(error_of("\ns 0 0 x 1\n"), "test.nff: line 2: centre is not a number: 'x'");
  EXPECT_EQ(error_of("p -1\n"), "test.nff: line 1: number of corners is negative");
  EXPECT_EQ(error_of("p 1000000000000\n0 0 0\n"), "test.nff: line 3: missing corner");
  EXPECT_EQ(error_of("v\nfrom 0 0 0\nup 0 0 1\n"),
            "test.nff: line 3: view: expected 'at', found 'up'");
  EXPECT_NE(error_of("v\nfrom 0 0 0\n").find("end of the file"), std::string::npos);
  EXPECT_NE(error_of("v\nfrom 0 0 nan at 0 0 0\n").find("not finite"), std::string::npos);
  EXPECT_NE(error_of("f 1 1 1 1 1 1 1 inf\n").find("not finite"), std::string::npos);
  std::string view = kView;
  EXPECT_NE(error_of(view.replace(view.find("512"), 3, "0")).find("resolution"), std::string::npos);
  view = kView;
  EXPECT_NE(error_of(view.replace(view.find("45"), 2, "180")).find("angle"), std::string::npos);
}

struct SharedFile {
  const char* name;
  std::size_t triangles, spheres, cones, polygons, lights, materials;
};

std::size_t count_of(const SceneData& scene, std::uint32_t geometry_id) {
  for (const Geometry& geometry : scene.geometries) {
    if (geometry.geometry_id == geometry_id) return geometry.size();
  }
  return 0;
}

std::size_t polygons_of(const SceneData& scene) {
  const Geometry& first = scene.geometries.front();
  if (first.geometry_id != 0) return 0;
  return first.face_ids.empty() ? first.size() : first.face_ids.back() + 1U;
}

TEST(Nff, TheSharedScenesHaveTheirPublishedCounts) {
  STRAHL_REQUIRE_SHARED("scenes");
  // gears: 16 gear faces of 144 corners, 1153 quadrilaterals.
  for (const SharedFile& file :
       {SharedFile{"spd_balls2.nff", 2, 91, 0, 1, 3, 2},
        SharedFile{"spd_gears2.nff", 16 * 142 + 1153 * 2, 0, 0, 1169, 5, 9},
        SharedFile{"spd_jacks2.nff", 0, 54, 27, 0, 1, 1},
        SharedFile{"spd_lattice3.nff", 0, 64, 144, 0, 6, 208},
        SharedFile{"spd_mount3.nff", 128, 4, 0, 128, 1, 2},
        SharedFile{"spd_nurbtst1.nff", 1500, 0, 0, 1500, 1, 1},
        SharedFile{"spd_rings2.nff", 2, 150, 150, 1, 3, 31},
        SharedFile{"spd_shells1.nff", 0, 361, 0, 0, 1, 1},
        SharedFile{"spd_sombrero1.nff", 1922, 0, 0, 1922, 1, 1},
        SharedFile{"spd_teapot3.nff", 9 * 2 + 552, 0, 0, 561, 2, 3},
        SharedFile{"spd_tetra3.nff", 64, 0, 0, 64, 1, 1},
        SharedFile{"spd_tree5.nff", 2, 63, 63, 1, 7, 2}}) {
    SCOPED_TRACE(file.name);
    const SceneData scene = read_nff(map_file(test::shared_dir() / "scenes" / file.name));
    EXPECT_EQ(count_of(scene, 0), file.triangles);
    EXPECT_EQ(count_of(scene, 1), file.spheres);
    EXPECT_EQ(count_of(scene, 2), file.cones);
    EXPECT_EQ(polygons_of(scene), file.polygons);
    EXPECT_EQ(scene.lights.size(), file.lights);
    EXPECT_EQ(scene.materials.size(), file.materials);
    EXPECT_TRUE(scene.view.has_value() && scene.background.has_value());
    EXPECT_TRUE(scene.warnings.empty());
  }
}

}  // namespace
}  // namespace strahl
