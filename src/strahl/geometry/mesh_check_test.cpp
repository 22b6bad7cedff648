#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/geometry/mesh_check.h>

namespace strahl {
namespace {

Geometry triangles(std::vector<Vec3d> vertices, std::vector<std::uint32_t> indices) {
  Geometry geometry;
  geometry.mesh = make_mesh(std::move(vertices), std::move(indices));
  return geometry;
}

const std::vector<Vec3d> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// A closed tetrahedron, outward.
const std::vector<std::uint32_t> kTetrahedron{0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};

/// "defect:count:first,first" of each finding.
std::string findings(const Geometry& geometry) {
  std::string text;
  for (const MeshFinding& finding : check_mesh(geometry)) {
    text += (text.empty() ? "" : " ") + std::string(name_of(finding.defect)) + ":" +
            std::to_string(finding.count);
    char separator = ':';
    for (const std::uint64_t id : finding.first) {
      text += separator + std::to_string(id);
      separator = ',';
    }
  }
  return text;
}

TEST(MeshCheck, ClosedMeshHasNoFindings) {
  EXPECT_EQ(findings(triangles(kCorners, kTetrahedron)), "");
}

TEST(MeshCheck, MissingTriangleLeavesThreeOpenEdges) {
  EXPECT_EQ(findings(triangles(kCorners, {0, 2, 1, 0, 1, 3, 1, 2, 3})), "open_edge:3:0,1,2");
}

TEST(MeshCheck, TurnedTriangleWindsAgainstItsThreeNeighbours) {
  EXPECT_EQ(findings(triangles(kCorners, {0, 1, 2, 0, 1, 3, 1, 2, 3, 2, 0, 3})),
            "inconsistent_winding:3:0,0,0");
}

TEST(MeshCheck, RepeatedTriangleIsADuplicateInAnyOrderOfItsCorners) {
  std::vector<std::uint32_t> indices = kTetrahedron;
  indices.insert(indices.end(), {2, 1, 0});
  EXPECT_EQ(findings(triangles(kCorners, indices)),
            "duplicate_triangle:1:4 non_manifold_edge:3:0,0,0");
}

TEST(MeshCheck, VerticesAtOnePositionCountAsOneAndMinusZeroIsZero) {
  std::vector<Vec3d> soup;
  std::vector<std::uint32_t> indices;
  for (const std::uint32_t i : kTetrahedron) {
    indices.push_back(static_cast<std::uint32_t>(soup.size()));
    Vec3d corner = kCorners[i];
    if (soup.size() % 2 == 1 && corner.x == 0.0) corner.x = -0.0;
    soup.push_back(corner);
  }
  EXPECT_EQ(findings(triangles(soup, indices)), "");
}

TEST(MeshCheck, DegenerateTrianglesAreToldApart) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vec3d> vertices = kCorners;
  vertices.push_back({2, 0, 0});
  vertices.push_back({nan, 0, 0});
  vertices.push_back({1, 0, 0});
  std::vector<std::uint32_t> indices = kTetrahedron;
  indices.insert(indices.end(), {0, 1, 4, 1, 2, 6, 0, 1, 5});
  EXPECT_EQ(
      findings(triangles(vertices, indices)),
      "zero_area:1:4 repeated_vertex:1:5 not_finite:1:6 non_manifold_edge:1:0 open_edge:2:4,4");
}

TEST(MeshCheck, IndexWithoutVertexAndHugeCoordinateAreOutOfRange) {
  std::vector<Vec3d> vertices = kCorners;
  vertices.push_back({1e200, 0, 0});
  EXPECT_EQ(findings(triangles(vertices, {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3, 0, 1, 9})),
            "out_of_range:1:4");
  vertices[0] = {1e-200, 0, 0};
  EXPECT_EQ(findings(triangles(vertices, kTetrahedron)), "out_of_range:3:0,1,3");
}

TEST(MeshCheck, KeepsTheFirstCasesOnly) {
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    // Farther triangles have lower coordinates, so that edges do not come in their order.
    const double x = -static_cast<double>(i);
    for (const Vec3d& v : {Vec3d{x, 0, 0}, Vec3d{x, 1, 0}, Vec3d{x, 0, 1}}) {
      indices.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(v);
    }
  }
  const std::vector<MeshFinding> found = check_mesh(triangles(vertices, indices), 4);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].count, 9000u);
  EXPECT_EQ(found[0].first, (std::vector<std::uint64_t>{0, 0, 0, 1}));
}

TEST(MeshCheck, SpheresThatCannotBeHitAreFound) {
  Geometry geometry;
  geometry.kind = PrimitiveKind::sphere;
  geometry.spheres = {{{0, 0, 0}, 1.0}, {{0, 0, 0}, -1.0}};
  EXPECT_EQ(findings(geometry), "invalid_curved:1:1");
}

TEST(MeshCheck, EmptyGeometryHasNoFindings) { EXPECT_EQ(findings(triangles({}, {})), ""); }

}  // namespace
}  // namespace strahl
