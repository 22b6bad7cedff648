// io/face_list_test.cpp - faces to triangles and their source faces.
#include <gtest/gtest.h>

#include <strahl/io/face_list.h>

namespace strahl {
namespace {

using Corners = std::vector<std::uint32_t>;

VertexBuffer square() {
  return make_vertex_buffer(std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
}

Corners triangle(const Geometry& geometry, std::size_t i) {
  const IndexView::Triple t = geometry.mesh.triangles[i];
  return {static_cast<std::uint32_t>(t.a), static_cast<std::uint32_t>(t.b),
          static_cast<std::uint32_t>(t.c)};
}

TEST(FaceList, TrianglesAloneNeedNoFaceIds) {
  FaceList faces(square());
  faces.add(Corners{0, 1, 2});
  faces.add(Corners{0, 2, 3});
  const Geometry geometry = faces.take_geometry();
  ASSERT_EQ(geometry.size(), 2u);
  EXPECT_EQ(triangle(geometry, 1), (Corners{0, 2, 3}));
  EXPECT_TRUE(geometry.face_ids.empty());
}

TEST(FaceList, PolygonsAndSkippedFacesAreNumberedInOrder) {
  FaceList faces(square());
  faces.add(Corners{0, 1, 2});
  faces.add(Corners{0, 2, 3});
  faces.add(Corners{});
  faces.add(Corners{0, 1, 2, 3});
  faces.add(Corners{0, 1});
  faces.add(Corners{1, 2, 3});
  EXPECT_EQ(faces.skipped(), 2u);
  const Geometry geometry = faces.take_geometry();
  EXPECT_EQ(geometry.face_ids, (Corners{0, 1, 3, 3, 5}));
  EXPECT_EQ(triangle(geometry, 2), (Corners{0, 1, 2}));
  EXPECT_EQ(triangle(geometry, 3), (Corners{0, 2, 3}));
}

TEST(FaceList, TheMeshKeepsItsMemoryAlive) {
  TriangleMesh mesh;
  {
    FaceList faces(square());
    faces.add(Corners{0, 1, 2});
    mesh = faces.take_geometry().mesh;
  }
  EXPECT_EQ(mesh[0].c, (Vec3d{1, 1, 0}));
}

TEST(FaceList, ASceneWithoutTrianglesSaysSo) {
  FaceList faces(square());
  faces.add(Corners{0, 1});
  SceneData scene;
  add_faces(faces, scene);
  EXPECT_TRUE(scene.geometries.empty());
  EXPECT_EQ(scene.warnings, (std::vector<std::string>{"1 faces with fewer than 3 vertices skipped",
                                                      "no triangles"}));
}

}  // namespace
}  // namespace strahl
