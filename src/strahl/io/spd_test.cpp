// io/spd_test.cpp - the SPD scenes against the reference program's output and published counts.
#include <cmath>
#include <fstream>
#include <string>
#include <tests/support/shared.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/io/generators.h>
#include <strahl/io/scene_writer.h>
#include <strahl/io/spd.h>
#include <strahl/io/temp_folder_test.h>

namespace strahl {
namespace {

std::vector<std::string> tokens_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::string> tokens;
  for (std::string token; file >> token;) tokens.push_back(token);
  return tokens;
}

// Where exact arithmetic gives 0, libm leaves something of the order of 1e-16 that differs between
// platforms; there, and only there, the digits need not be equal.
bool is_same_token(const std::string& a, const std::string& b) {
  if (a == b) return true;
  char *end_a = nullptr, *end_b = nullptr;
  const double x = std::strtod(a.c_str(), &end_a), y = std::strtod(b.c_str(), &end_b);
  return *end_a == 0 && *end_b == 0 && std::abs(x) < 1e-12 && std::abs(y) < 1e-12;
}

class SpdReference : public testing::TestWithParam<const char*> {};

TEST_P(SpdReference, EveryPrintedNumberIsThatOfTheOriginalProgram) {
  const std::string name = GetParam();
  const std::string relative = "scenes/spd_" + name + ".nff";
  STRAHL_REQUIRE_SHARED(relative);
  const std::string spec =
      "gen:" + name.substr(0, name.size() - 1) + ":" + name.substr(name.size() - 1);
  const test::TempFolder folder;
  write_generated(spec, folder / "scene.nff");

  const std::vector<std::string> reference = tokens_of(test::shared_dir() / relative);
  const std::vector<std::string> ours = tokens_of(folder / "scene.nff");
  ASSERT_EQ(ours.size(), reference.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    ASSERT_TRUE(is_same_token(ours[i], reference[i]))
        << "token " << i << ": " << ours[i] << ", reference " << reference[i];
  }
}

INSTANTIATE_TEST_SUITE_P(Files, SpdReference,
                         testing::Values("balls2", "gears2", "jacks2", "lattice3", "mount3",
                                         "rings2", "shells1", "sombrero1", "teapot3", "tetra3",
                                         "tree5"),
                         [](const auto& test) { return std::string(test.param); });

struct Counts {
  const char* spec;
  std::size_t polygons, spheres, cones;
};

TEST(Spd, CountsFollowThePublishedFormulas) {
  const std::vector<Counts> table{
      {"balls:1", 1, 10, 0},
      {"balls:2", 1, 91, 0},
      {"balls:3", 1, 820, 0},
      {"balls", 1, 7381, 0},
      {"balls:5", 1, 66430, 0},
      {"gears:1", 147, 0, 0},
      {"gears:2", 1169, 0, 0},
      {"gears:3", 3943, 0, 0},
      {"gears", 9345, 0, 0},
      {"gears:9", 106435, 0, 0},
      {"jacks", 0, 6, 3},
      {"jacks:2", 0, 54, 27},
      {"jacks:3", 0, 438, 219},
      {"jacks:4", 0, 3510, 1755},
      {"jacks:5", 0, 28086, 14043},
      {"lattice:1", 0, 8, 12},
      {"lattice:5", 0, 216, 540},
      {"lattice:6", 0, 343, 882},
      {"lattice", 0, 2197, 6084},
      {"lattice:29", 0, 27000, 78300},
      {"mount:3", 128, 4, 0},
      {"mount:4", 512, 4, 0},
      {"mount:5", 2048, 4, 0},
      {"mount", 8192, 4, 0},
      {"mount:8", 131072, 4, 0},
      {"rings:1", 1, 30, 30},
      {"rings:3", 1, 420, 420},
      {"rings", 1, 4200, 4200},
      {"rings:17", 1, 53550, 53550},
      {"sombrero", 1922, 0, 0},
      {"sombrero:2", 7938, 0, 0},
      {"sombrero:3", 32258, 0, 0},
      {"sombrero:4", 130050, 0, 0},
      {"teapot:1", 57, 0, 0},
      {"teapot:2", 244, 0, 0},
      {"teapot:4", 1008, 0, 0},
      {"teapot:6", 2292, 0, 0},
      {"teapot", 9264, 0, 0},
      {"teapot:40", 103680, 0, 0},
      {"tetra:1", 4, 0, 0},
      {"tetra:5", 1024, 0, 0},
      {"tetra", 4096, 0, 0},
      {"tetra:8", 65536, 0, 0},
      {"tree:1", 1, 3, 3},
      {"tree:8", 1, 511, 511},
      {"tree", 1, 4095, 4095},
      {"tree:15", 1, 65535, 65535},
      {"shells:1", 0, 361, 0},
      {"shells", 0, 5761, 0},
  };
  for (const Counts& row : table) {
    const std::optional<NffScene> scene = generate_nff_scene(row.spec);
    ASSERT_TRUE(scene);
    EXPECT_EQ(scene->polygons.size(), row.polygons) << row.spec;
    EXPECT_EQ(scene->spheres.size(), row.spheres) << row.spec;
    EXPECT_EQ(scene->cones.size(), row.cones) << row.spec;
    EXPECT_EQ(scene->objects.size(), row.polygons + row.spheres + row.cones) << row.spec;
  }
}

TEST(Spd, BoxesAreThoseMeasuredFromTheOriginalFiles) {
  const auto box_of = [](const char* spec) {
    Aabb box;
    const NffScene scene = *generate_nff_scene(spec);
    for (const Vec3d& p : scene.vertices) box.extend(p);
    for (const Sphere& s : scene.spheres) {
      box.extend(s.center - Vec3d::all(s.radius)), box.extend(s.center + Vec3d::all(s.radius));
    }
    // Those files' boxes took cones as the balls at their ends.
    for (const Cone& c : scene.cones) {
      box.extend(c.base - Vec3d::all(c.base_radius)),
          box.extend(c.apex + Vec3d::all(c.apex_radius));
    }
    return box.extent();
  };
  const auto expect_near = [](const Vec3d& a, const Vec3d& b, double tolerance) {
    EXPECT_LT(norm_max(a - b), tolerance) << a.x << " " << a.y << " " << a.z;
  };
  expect_near(box_of("balls"), {24, 24, 1.331}, 5e-4);
  expect_near(box_of("gears"), {4, 4, 1}, 1e-9);
  expect_near(box_of("lattice"), {1.042, 1.042, 1.042}, 5e-4);
  expect_near(box_of("mount"), {2.16, 2.16, 2.081}, 5e-3);
  expect_near(box_of("rings"), {19.68, 19.25, 19.68}, 5e-3);
  expect_near(box_of("teapot"), {8, 8, 3.15}, 5e-3);
  expect_near(box_of("tetra"), {2, 2, 2}, 1e-9);
  expect_near(box_of("tree"), {100, 100, 3.287}, 5e-4);
}

TEST(Spd, NumbersAreRoundedToSixDigitsUnlessFullPrecisionIsAskedFor) {
  const NffScene printed = *generate_nff_scene("gen:balls:1");
  const NffScene full = *generate_nff_scene("gen:balls:1,precision=full");
  EXPECT_EQ(printed.spheres[1].radius, 0.166667);
  EXPECT_EQ(full.spheres[1].radius, 0.5 / 3.0);
  EXPECT_NEAR(full.spheres[1].center.x, printed.spheres[1].center.x, 1e-6);
  EXPECT_NE(full.spheres[1].center.x, printed.spheres[1].center.x);
  EXPECT_EQ(generate_nff_scene("rings:1")->view->from.y, -2.61313);
}

TEST(Spd, SceneDataNumbersGeometriesAndFacesAsTheFormatDemands) {
  const SceneData gears = generate_scene("gen:gears:1");
  ASSERT_EQ(gears.geometries.size(), 1u);
  // The square, two faces of 144 corners, 144 quads.
  const Geometry& triangles = gears.geometries[0];
  ASSERT_EQ(triangles.size(), 2u + 2 * 142 + 2 * 144);
  EXPECT_EQ(triangles.face_ids.front(), 0u);
  EXPECT_EQ(triangles.face_ids[2], 1u);
  EXPECT_EQ(triangles.face_ids[2 + 142], 2u);
  EXPECT_EQ(triangles.face_ids.back(), 146u);
  EXPECT_EQ(triangles.materials.front(), 0u);
  EXPECT_EQ(triangles.materials.back(), 1u);

  const SceneData tree = generate_scene("gen:tree:2");
  ASSERT_EQ(tree.geometries.size(), 3u);
  for (std::uint32_t id = 0; id < 3; ++id) EXPECT_EQ(tree.geometries[id].geometry_id, id);
  EXPECT_EQ(tree.geometries[1].materials, std::vector<std::uint32_t>(7, 1));
  EXPECT_EQ(tree.lights.size(), 7u);
  EXPECT_EQ(tree.source, "gen:tree:2");

  const SceneData jacks = generate_scene("jacks");
  ASSERT_EQ(jacks.geometries.size(), 2u);
  EXPECT_EQ(jacks.geometries[0].geometry_id, 1u);
  EXPECT_EQ(jacks.geometries[1].geometry_id, 2u);
}

TEST(Spd, AreaOfTheConcaveGearFacesIsThatOfTheirTriangles) {
  const NffScene scene = *generate_nff_scene("gears:1,precision=full");
  const NffPolygon& face = scene.polygons[1];
  double outline = 0.0;
  for (std::uint32_t i = 0; i < face.vertex_count; ++i) {
    const Vec3d& p = scene.vertices[face.first_vertex + i];
    const Vec3d& q = scene.vertices[face.first_vertex + (i + 1) % face.vertex_count];
    outline += 0.5 * (p.x * q.y - p.y * q.x);
  }
  const SceneData data = to_scene_data(scene);
  double covered = 0.0;
  for (std::size_t i = 2; i < 144; ++i) {
    const TriangleVertices t = data.geometries[0].mesh[i];
    const double area = 0.5 * cross(t.b - t.a, t.c - t.a).z;
    EXPECT_GT(area, 0.0);
    covered += area;
  }
  EXPECT_NEAR(covered, outline, 1e-12);
}

TEST(Spd, RoundingIsThatOfPrintf) {
  for (const double value : {0.1234565, 1.0 / 3.0, 123456.5, 1234567.0, 1e-300, 9.999995, -0.5}) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    EXPECT_EQ(round_to_six_digits(value), std::strtod(text, nullptr)) << value;
  }
}

}  // namespace
}  // namespace strahl
