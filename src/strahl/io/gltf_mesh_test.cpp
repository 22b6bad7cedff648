// io/gltf_mesh_test.cpp - primitives and accessors: modes, types, strides, sparse data, ranges.
#include <tests/support/gltf_file.h>

#include <gtest/gtest.h>

namespace strahl {
namespace {

using nlohmann::json;
using test::GltfFile;
using test::indices_of;
using test::one_triangle;

using Indices = std::vector<std::uint64_t>;

const std::vector<float> kSix = {0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0, 5, 0, 0};

// A file whose only primitive has six vertices; `more` is merged into the primitive.
GltfFile six_vertices(const json& more = json::object()) {
  GltfFile file;
  file.mesh(file.positions(kSix));
  file.root["nodes"] = {{{"mesh", 0}}};
  file.root["meshes"][0]["primitives"][0].update(more);
  return file;
}

TriangleMesh mesh_of(const GltfFile& file) { return file.read().geometries.at(0).mesh; }

GltfFile with_indices(const std::vector<std::uint16_t>& indices, int mode = 4) {
  GltfFile file = six_vertices({{"mode", mode}});
  const std::size_t accessor = file.indices(indices);
  file.root["meshes"][0]["primitives"][0]["indices"] = accessor;
  return file;
}

TEST(GltfMesh, UsesPositionsAndWideIndicesInPlace) {
  GltfFile file = six_vertices();
  file.root["meshes"][0]["primitives"][0]["indices"] =
      file.accessor<std::uint32_t>({5, 4, 3}, test::kUint32, "SCALAR", 1);
  const FileBytes bytes = test::memory_file(file.glb());
  const SceneData scene = read_gltf(bytes);
  const TriangleMesh& mesh = scene.geometries.at(0).mesh;
  const auto is_inside = [&](const std::byte* p) {
    return p >= bytes.bytes.data() && p < bytes.bytes.data() + bytes.bytes.size();
  };
  EXPECT_TRUE(is_inside(mesh.vertices.data));
  EXPECT_TRUE(is_inside(mesh.triangles.data));
  EXPECT_EQ(indices_of(mesh), (Indices{5, 4, 3}));
}

TEST(GltfMesh, KeepsItsFileAlive) {
  TriangleMesh mesh;
  {
    const FileBytes bytes = test::memory_file(six_vertices().glb());
    mesh = read_gltf(bytes).geometries.at(0).mesh;
  }
  EXPECT_EQ(mesh[1].c, Vec3d(5, 0, 0));
}

TEST(GltfMesh, ReadsBuffersInDataUris) {
  const SceneData scene = read_gltf(test::memory_file(with_indices({0, 1, 5}).text(), "a.gltf"));
  EXPECT_EQ(scene.geometries.at(0).mesh[0].c, Vec3d(5, 0, 0));
}

TEST(GltfMesh, TakesVerticesInOrderWithoutIndices) {
  EXPECT_EQ(indices_of(mesh_of(six_vertices())), (Indices{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(indices_of(mesh_of(six_vertices({{"mode", 6}}))),
            (Indices{1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5, 0}));
}

TEST(GltfMesh, ReadsIndicesOfEveryWidth) {
  GltfFile file = six_vertices();
  const std::size_t narrow = file.accessor<std::uint8_t>({2, 1, 0}, test::kUint8, "SCALAR", 1);
  file.root["meshes"][0]["primitives"][0]["indices"] = narrow;
  EXPECT_EQ(indices_of(mesh_of(file)), (Indices{2, 1, 0}));
  EXPECT_EQ(indices_of(mesh_of(with_indices({3, 1, 0}))), (Indices{3, 1, 0}));
  file.root["accessors"][narrow]["componentType"] = test::kInt8;
  EXPECT_EQ(file.error(),
            "a.glb: /meshes/0/primitives/0/indices: indices must be unsigned integers");
}

TEST(GltfMesh, TurnsEverySecondTriangleOfAStrip) {
  EXPECT_EQ(indices_of(mesh_of(with_indices({0, 1, 2, 3, 4}, 5))),
            (Indices{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  EXPECT_EQ(mesh_of(with_indices({0, 1}, 5)).size(), 0u);
}

TEST(GltfMesh, FansAroundTheFirstIndex) {
  EXPECT_EQ(indices_of(mesh_of(with_indices({5, 1, 2, 3}, 6))), (Indices{1, 2, 5, 2, 3, 5}));
}

TEST(GltfMesh, IgnoresLeftOverIndicesWithAWarning) {
  const SceneData scene = with_indices({0, 1, 2, 3}).read();
  EXPECT_EQ(indices_of(scene.geometries.at(0).mesh), (Indices{0, 1, 2}));
  EXPECT_EQ(scene.warnings, std::vector<std::string>{"/meshes/0/primitives/0/indices: the count is "
                                                     "not a multiple of 3"});
}

TEST(GltfMesh, CitesTheFirstIndexOutOfRange) {
  EXPECT_EQ(with_indices({0, 1, 2, 3, 6, 7}).error(),
            "a.glb: /meshes/0/primitives/0/indices: index 6 (corner 1 of triangle 1), but there "
            "are 6 vertices");
  EXPECT_NE(with_indices({0, 1, 6}).error().find("index 6 (corner 2 of triangle 0)"),
            std::string::npos);
  GltfFile wide = six_vertices();
  wide.root["meshes"][0]["primitives"][0]["indices"] =
      wide.accessor<std::uint32_t>({0, 1, 0xFFFFFFFF}, test::kUint32, "SCALAR", 1);
  EXPECT_NE(wide.error().find("index 4294967295 (corner 2 of triangle 0)"), std::string::npos);
}

TEST(GltfMesh, ChecksSharedIndicesAgainstEachPrimitivesVertices) {
  GltfFile file = with_indices({0, 1, 5});
  const std::size_t few = file.positions({0, 0, 0, 1, 1, 1});
  json second = file.root["meshes"][0]["primitives"][0];
  second["attributes"]["POSITION"] = few;
  file.root["meshes"][0]["primitives"].push_back(second);
  EXPECT_NE(file.error().find("/meshes/0/primitives/1/indices: index 5"), std::string::npos);
}

TEST(GltfMesh, FollowsStridesAndOffsets) {
  GltfFile file = six_vertices();
  file.root["bufferViews"][0]["byteStride"] = 24;
  file.root["accessors"][0]["byteOffset"] = 12;
  file.root["accessors"][0]["count"] = 3;
  const TriangleVertices t = mesh_of(file)[0];
  EXPECT_EQ(t.a, Vec3d(1, 0, 0));
  EXPECT_EQ(t.b, Vec3d(3, 0, 0));
  EXPECT_EQ(t.c, Vec3d(5, 0, 0));
  file.root["accessors"][0]["count"] = 4;
  EXPECT_EQ(file.error(),
            "a.glb: /accessors/0: 4 elements reach past the 72 bytes of the buffer view");
  // From byte 12 on, five packed elements are left.
  file.root["bufferViews"][0]["byteStride"] = 12;
  file.root["accessors"][0]["count"] = 5;
  EXPECT_EQ(file.error(), "no error");
  file.root["accessors"][0]["count"] = 6;
  EXPECT_NE(file.error().find("6 elements reach past"), std::string::npos);
  file.root["bufferViews"][0]["byteStride"] = 8;
  EXPECT_EQ(file.error(), "a.glb: /accessors/0: the stride is shorter than an element");
}

TEST(GltfMesh, DecodesQuantizedPositions) {
  GltfFile file;
  file.mesh(
      file.accessor<std::int16_t>({-32768, 32767, 0, 1, 2, 3, 4, 5, 6}, test::kInt16, "VEC3", 3));
  file.root["nodes"] = {{{"mesh", 0}}};
  EXPECT_EQ(mesh_of(file)[0].a, Vec3d(-32768, 32767, 0));
  file.root["accessors"][0]["normalized"] = true;
  EXPECT_EQ(mesh_of(file)[0].a, Vec3d(-1, 1, 0));
}

TEST(GltfMesh, ReplacesElementsOfASparseAccessor) {
  GltfFile file = six_vertices();
  const std::size_t where = file.view<std::uint8_t>({1, 4});
  const std::size_t what = file.view<float>({0, 7, 0, 0, 8, 0});
  json& accessor = file.root["accessors"][0];
  accessor["sparse"] = {{"count", 2},
                        {"indices", {{"bufferView", where}, {"componentType", test::kUint8}}},
                        {"values", {{"bufferView", what}}}};
  const TriangleMesh mesh = mesh_of(file);
  EXPECT_EQ(mesh[0].a, Vec3d(0, 0, 0));
  EXPECT_EQ(mesh[0].b, Vec3d(0, 7, 0));
  EXPECT_EQ(mesh[1].b, Vec3d(0, 8, 0));
  EXPECT_EQ(mesh[1].c, Vec3d(5, 0, 0));

  accessor.erase("bufferView");
  EXPECT_EQ(mesh_of(file)[1].c, Vec3d(0, 0, 0));
  EXPECT_EQ(mesh_of(file)[1].b, Vec3d(0, 8, 0));

  accessor["count"] = 4;
  EXPECT_EQ(file.error(),
            "a.glb: /accessors/0/sparse/indices: sparse index 4 at position 1, but there are 4 "
            "elements");
}

TEST(GltfMesh, SurvivesRangesThatWrapAround) {
  GltfFile file = six_vertices();
  file.root["accessors"][0]["byteOffset"] = UINT64_MAX - 3;
  EXPECT_NE(file.error().find("/accessors/0: 6 elements reach past"), std::string::npos);
  file = six_vertices();
  file.root["bufferViews"][0]["byteStride"] = std::uint64_t{1} << 62;
  EXPECT_NE(file.error().find("/accessors/0: 6 elements reach past"), std::string::npos);
  file = six_vertices();
  file.root["bufferViews"][0]["byteOffset"] = UINT64_MAX - 15;
  EXPECT_NE(file.error().find("/bufferViews/0: reaches past the 72 bytes"), std::string::npos);
  file = six_vertices();
  file.root["accessors"][0]["count"] = UINT64_MAX;
  EXPECT_NE(file.error().find("/accessors/0/count: more than 2^32 - 1"), std::string::npos);
}

TEST(GltfMesh, RefusesToExpandASmallFileToGigabytes) {
  GltfFile file = six_vertices();
  file.root["accessors"][0].erase("bufferView");
  file.root["accessors"][0]["count"] = 3'000'000'000;
  EXPECT_NE(file.error().find("far more than"), std::string::npos);

  // Each copy is affordable, all together are not.
  GltfFile copies = six_vertices();
  copies.root["accessors"][0].erase("bufferView");
  copies.root["accessors"][0]["count"] = 1'000'000;
  copies.root["materials"] = {json::object(), json::object()};
  copies.root["meshes"][0]["primitives"][0]["material"] = 1;
  for (int i = 0; i < 100; ++i) copies.root["meshes"].push_back(copies.root["meshes"][0]);
  EXPECT_NE(copies.error().find("far more than"), std::string::npos);
}

TEST(GltfMesh, RefusesTypesThatCannotBePositionsOrIndices) {
  GltfFile file = six_vertices();
  file.root["accessors"][0]["type"] = "VEC2";
  EXPECT_EQ(file.error(),
            "a.glb: /meshes/0/primitives/0/attributes/POSITION: the accessor has 2 components per "
            "element, not 3");
  file.root["accessors"][0]["type"] = "MAT2";
  EXPECT_EQ(file.error(), "a.glb: /accessors/0/type: type 'MAT2' cannot be used here");
  file.root["accessors"][0]["type"] = "VEC3";
  file.root["accessors"][0]["componentType"] = test::kUint32;
  EXPECT_NE(file.error().find("positions of 32-bit integers"), std::string::npos);
  file.root["accessors"][0]["componentType"] = 5124;
  EXPECT_EQ(file.error(), "a.glb: /accessors/0/componentType: unknown component type 5124");
  EXPECT_EQ(six_vertices({{"mode", 7}}).error(),
            "a.glb: /meshes/0/primitives/0/mode: unknown mode 7");
}

TEST(GltfMesh, SkipsAPrimitiveWithoutPositions) {
  GltfFile file = six_vertices();
  file.root["meshes"][0]["primitives"][0]["attributes"] = json::object();
  const SceneData scene = file.read();
  EXPECT_EQ(scene.geometries.at(0).size(), 0u);
  EXPECT_EQ(scene.warnings.at(0), "/meshes/0/primitives/0: a primitive without POSITION skipped");
}

}  // namespace
}  // namespace strahl
