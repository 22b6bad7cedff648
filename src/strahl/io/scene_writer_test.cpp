// io/scene_writer_test.cpp - PLY and NFF files as written, byte by byte where it matters.
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/io/generators.h>
#include <strahl/io/nff.h>
#include <strahl/io/scene_writer.h>
#include <strahl/io/temp_folder_test.h>

namespace strahl {
namespace {

using test::TempFolder;

SceneData one_triangle(double x) {
  SceneData data;
  data.geometries.emplace_back().mesh = make_mesh(
      std::vector<Vec3d>{{0, 0, 0}, {x, 0, 0}, {0, 1, 0}}, std::vector<std::uint32_t>{0, 1, 2});
  return data;
}

template <class T>
T value_at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

template <class F>
void expect_error(F write, ErrorCode code, const std::string& needle) {
  try {
    write();
    ADD_FAILURE() << "expected an error about " << needle;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    EXPECT_NE(std::string(error.what()).find(needle), std::string::npos) << error.what();
  }
}

TEST(PlyWriter, WritesFloatsWhereTheyAreExact) {
  const TempFolder folder;
  write_ply(one_triangle(2.5), folder / "a.ply");
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  const std::string bytes = folder.read("a.ply");
  ASSERT_EQ(bytes.size(), header.size() + 3 * 12 + 13);
  EXPECT_EQ(bytes.substr(0, header.size()), header);
  EXPECT_EQ(value_at<float>(bytes, header.size() + 12), 2.5f);
  const std::size_t face = header.size() + 36;
  EXPECT_EQ(bytes[face], 3);
  EXPECT_EQ(value_at<std::int32_t>(bytes, face + 1), 0);
  EXPECT_EQ(value_at<std::int32_t>(bytes, face + 9), 2);
}

TEST(PlyWriter, WritesDoublesWhereFloatsWouldRound) {
  const TempFolder folder;
  write_ply(one_triangle(0.1), folder / "a.ply");
  const std::string bytes = folder.read("a.ply");
  const std::size_t body = bytes.find("end_header\n") + 11;
  EXPECT_NE(bytes.find("property double x"), std::string::npos);
  ASSERT_EQ(bytes.size(), body + 3 * 24 + 13);
  EXPECT_EQ(value_at<double>(bytes, body + 24), 0.1);
}

TEST(PlyWriter, FlattensInstancesIntoWorldSpace) {
  SceneData data = one_triangle(1.0);
  data.instances = {{0, 1, Affine{}, 0}, {0, 1, Affine::translation({10, 0, 0}), 1}};
  const TempFolder folder;
  write_ply(data, folder / "a.ply");
  const std::string bytes = folder.read("a.ply");
  const std::size_t body = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size(), body + 6 * 12 + 2 * 13);
  EXPECT_EQ(value_at<float>(bytes, body + 4 * 12), 11.0f);
  EXPECT_EQ(value_at<std::int32_t>(bytes, body + 72 + 13 + 1), 3);
}

TEST(PlyWriter, WritesSpheresAsVerticesWithARadius) {
  const TempFolder folder;
  write_generated("gen:shells:1", folder / "a.ply");
  const std::string bytes = folder.read("a.ply");
  EXPECT_NE(bytes.find("element vertex 361\n"), std::string::npos);
  EXPECT_NE(bytes.find("property double radius\nend_header\n"), std::string::npos);
  const std::size_t body = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size(), body + 361 * 32);
  EXPECT_EQ(value_at<double>(bytes, body + 360 * 32 + 24), 16.902);
}

TEST(PlyWriter, RefusesWhatPlyCannotHoldAndLeavesNoFile) {
  const TempFolder folder;
  for (const char* spec : {"balls:1", "tree:1", "jacks:1"}) {
    expect_error([&] { write_generated(spec, folder / "a.ply"); }, ErrorCode::usage, ".nff");
  }
  expect_error([&] { write_generated("balls:1", folder / "a.obj"); }, ErrorCode::usage, ".ply");
  EXPECT_EQ(folder.count(), 0);
}

TEST(SceneWriter, ProgressAscendsAndCancelsWithoutLeavingAFile) {
  const TempFolder folder;
  for (const std::string name : {"a.ply", "a.nff"}) {
    double last = 0.0;
    int calls = 0;
    const auto listen = [&](double fraction, std::string_view stage) {
      EXPECT_EQ(stage, "writing");
      EXPECT_GE(fraction, last);
      last = fraction, ++calls;
      return true;
    };
    write_generated("terrain:64", folder / name, listen);
    EXPECT_EQ(last, 1.0);
    EXPECT_GT(calls, 3);
    const int middle = calls / 2;
    calls = 0;
    const auto cancel = [&](double, std::string_view) { return ++calls < middle; };
    const std::string other = "other_" + name;
    expect_error([&] { write_generated("terrain:64", folder / other, cancel); },
                 ErrorCode::cancelled, "cancelled");
    EXPECT_EQ(calls, middle);
  }
  EXPECT_EQ(folder.count(), 2);
}

TEST(PlyWriter, AnEmptySceneIsAFileWithoutFaces) {
  const TempFolder folder;
  write_ply(SceneData{}, folder / "a.ply");
  EXPECT_NE(folder.read("a.ply").find("element face 0\n"), std::string::npos);
}

TEST(NffWriter, WritesViewLightsFillsAndObjectsInOrder) {
  const TempFolder folder;
  write_generated("gen:tetra:1", folder / "a.NFF");
  const std::string expected =
      "b 0.078 0.361 0.753\nv\nfrom 1.02285 -3.17715 -2.17451\n"
      "at -0.004103 -0.004103 0.216539\nup -0.816497 -0.816497 0.816497\nangle 45\n"
      "hither 1\nresolution 512 512\nl 2 -18 -5\nf 1 0.2 0.2 1 0 100000 0 0\n"
      "p 3\n-1 -1 1\n-1 1 -1\n1 -1 -1\n";
  EXPECT_EQ(folder.read("a.NFF").substr(0, expected.size()), expected);
}

template <class T, class Equal>
void expect_equal(const std::vector<T>& a, const std::vector<T>& b, Equal equal) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(equal(a[i], b[i])) << i;
}

void expect_same_mesh(const TriangleMesh& a, const TriangleMesh& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const TriangleVertices s = a[i], t = b[i];
    ASSERT_TRUE(s.a == t.a && s.b == t.b && s.c == t.c) << i;
  }
}

bool is_same_fill(const Material& a, const Material& b) {
  return a.color == b.color && a.diffuse == b.diffuse && a.specular == b.specular &&
         a.shine == b.shine && a.transmission == b.transmission &&
         a.refraction_index == b.refraction_index;
}

// What each primitive looks like; a file repeats fills that a generator has once.
std::vector<Material> fills_of(const SceneData& data, const Geometry& geometry) {
  std::vector<Material> fills;
  for (const std::uint32_t material : geometry.materials) {
    fills.push_back(data.materials.at(material));
  }
  return fills;
}

void expect_same_scene(const SceneData& a, const SceneData& b) {
  ASSERT_EQ(a.geometries.size(), b.geometries.size());
  for (std::size_t g = 0; g < a.geometries.size(); ++g) {
    const Geometry &x = a.geometries[g], &y = b.geometries[g];
    EXPECT_EQ(x.kind, y.kind);
    EXPECT_EQ(x.geometry_id, y.geometry_id);
    EXPECT_EQ(x.face_ids, y.face_ids);
    expect_equal(fills_of(a, x), fills_of(b, y), is_same_fill);
    expect_same_mesh(x.mesh, y.mesh);
    expect_equal(x.spheres, y.spheres, [](const Sphere& s, const Sphere& t) {
      return s.center == t.center && s.radius == t.radius;
    });
    expect_equal(x.cones, y.cones, [](const Cone& s, const Cone& t) {
      return s.base == t.base && s.base_radius == t.base_radius && s.apex == t.apex &&
             s.apex_radius == t.apex_radius;
    });
  }
  EXPECT_EQ(a.lights, b.lights);
  EXPECT_EQ(a.background, b.background);
  ASSERT_EQ(a.view.has_value(), b.view.has_value());
  if (!a.view) return;
  EXPECT_TRUE(a.view->from == b.view->from && a.view->at == b.view->at && a.view->up == b.view->up);
  EXPECT_EQ(a.view->fov_degrees, b.view->fov_degrees);
  EXPECT_EQ(a.view->width, b.view->width);
}

TEST(NffWriter, TheFileOfAStandardSceneReadsBackAsTheGeneratedScene) {
  const TempFolder folder;
  for (const std::string name : {"balls:2", "gears:2", "jacks:2", "lattice:2", "mount:2", "rings:2",
                                 "sombrero:1", "teapot:2", "tetra:2", "tree:3", "shells:1"}) {
    for (const char* precision : {",precision=g6", ",precision=full"}) {
      SCOPED_TRACE(name + precision);
      write_generated(name + precision, folder / "a.nff");
      expect_same_scene(read_nff(map_file(folder / "a.nff")), generate_scene(name + precision));
    }
  }
}

TEST(NffWriter, TheFileOfAMeshReadsBackAsTheSameTriangles) {
  const TempFolder folder;
  for (const char* spec : {"icosphere:2,offset=1e6", "stadium:1000,steps=2", "soup:100"}) {
    write_generated(spec, folder / "a.nff");
    const SceneData read = read_nff(map_file(folder / "a.nff"));
    expect_same_mesh(read.geometries.at(0).mesh, generate_scene(spec).geometries.at(0).mesh);
  }
}

TEST(NffWriter, WritesAnySceneAsTrianglesInWorldSpace) {
  SceneData data = one_triangle(0.1);
  data.instances = {{0, 1, Affine::translation({0, 0, 5}), 0}};
  const TempFolder folder;
  write_nff(data, folder / "a.nff");
  EXPECT_EQ(folder.read("a.nff"), "f 0.8 0.8 0.8 1 0 0 0 1\np 3\n0 0 5\n0.1 0 5\n0 1 5\n");
}

TEST(NffWriter, KeepsNumbersThatAreNotFinite) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  SceneData data = one_triangle(-kInf);
  data.geometries[0].mesh =
      make_mesh(std::vector<Vec3d>{{kInf, -kInf, 0}, {std::nan(""), 0, 0}, {0, 1, 0}},
                std::vector<std::uint32_t>{0, 1, 2});
  const TempFolder folder;
  write_nff(data, folder / "a.nff");
  const TriangleVertices t = read_nff(map_file(folder / "a.nff")).geometries.at(0).mesh[0];
  EXPECT_EQ(t.a, (Vec3d{kInf, -kInf, 0}));
  EXPECT_TRUE(std::isnan(t.b.x));
}

TEST(SceneWriters, RefuseMovedSpheresAndLeaveNoFile) {
  const TempFolder folder;
  SceneData moved = generate_scene("shells:1");
  moved.instances = {{0, 1, Affine::translation({1, 0, 0}), 0}};
  expect_error([&] { write_nff(moved, folder / "a.nff"); }, ErrorCode::usage, "instance");
  expect_error([&] { write_ply(moved, folder / "a.ply"); }, ErrorCode::usage, "instance");
  moved.instances.clear(), moved.materials.clear();
  moved.geometries[0].materials[7] = 1;
  expect_error([&] { write_nff(moved, folder / "a.nff"); }, ErrorCode::bad_input, "material");
  EXPECT_EQ(folder.count(), 0);
}

}  // namespace
}  // namespace strahl
