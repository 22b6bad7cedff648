#include <cmath>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/geometry/scene.h>

namespace strahl {
namespace {

Geometry triangles(std::vector<Vec3d> vertices, std::vector<std::uint32_t> indices) {
  Geometry g;
  g.mesh = make_mesh(std::move(vertices), std::move(indices));
  return g;
}

SceneData one(Geometry g) {
  SceneData data;
  data.source = "test";
  data.geometries.push_back(std::move(g));
  return data;
}

std::vector<Vec3d> corners() { return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; }

/// Code and message of what Scene throws.
std::string refusal(SceneData data) {
  try {
    const Scene scene(std::move(data));
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Scene, AnIndexOutOfRangeIsNamed) {
  EXPECT_EQ(refusal(one(triangles(corners(), {0, 1, 2, 0, 1, 4}))),
            "test: triangle 1: vertex index 4 of 4 vertices");
}

TEST(Scene, ACoordinateOutOfRangeIsNamed) {
  auto v = corners();
  v[2].y = 0x1p250;
  EXPECT_EQ(refusal(one(triangles(v, {0, 1, 2}))),
            "test: vertex 2: a coordinate's magnitude is outside 2^-240..2^240");
}

TEST(Scene, ANearlySingularInstanceIsNamed) {
  SceneData data = one(triangles(corners(), {0, 1, 2}));
  data.instances.push_back({0, 1, Affine::scaling({1, 1, 1e-12}), 7});
  EXPECT_EQ(refusal(std::move(data)),
            "test: instance 7: its transformation is singular or nearly so (condition above 2^30)");
}

TEST(Scene, AnInstanceOfNothingIsNamed) {
  SceneData data = one(triangles(corners(), {0, 1, 2}));
  data.instances.push_back({0, 2, {}, 3});
  EXPECT_EQ(refusal(std::move(data)), "test: instance 3: refers to a geometry that does not exist");
}

TEST(Scene, RefusedTrianglesKeepTheirIdsAndAreCounted) {
  auto v = corners();
  v.push_back({2, 0, 0});
  v.push_back({std::nan(""), 0, 0});
  const Scene scene(one(triangles(v, {0, 1, 4, 1, 1, 2, 0, 1, 5, 0, 1, 2})));
  EXPECT_EQ(scene.counts().refused_zero_area, 1u);
  EXPECT_EQ(scene.counts().refused_repeated_vertex, 1u);
  EXPECT_EQ(scene.counts().refused_not_finite, 1u);
  EXPECT_EQ(scene.size(), 4u);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_TRUE(scene.bounds(i).is_empty());
  EXPECT_EQ(scene.bounds(3), (Aabb{{0, 0, 0}, {1, 1, 0}}));
  EXPECT_EQ(scene.id_of(3), (PrimitiveId{0, 0, 3}));
}

TEST(Scene, ReferencesAreNumberedPartByPart) {
  SceneData data;
  for (std::uint32_t g = 0; g < 3; ++g) {
    data.geometries.push_back(triangles(corners(), {0, 1, 2, 0, 1, 3}));
    data.geometries.back().geometry_id = 10 + g;
  }
  for (std::uint32_t i = 0; i < 100; ++i)
    data.instances.push_back({i % 2, 2, Affine::translation({double(i), 0, 0}), 50 + i});
  const Scene scene(std::move(data));
  ASSERT_EQ(scene.size(), 400u);
  for (std::uint32_t r = 0; r < scene.size(); ++r) {
    const std::uint32_t i = r / 4, g = i % 2 + r % 4 / 2;
    ASSERT_EQ(scene.id_of(r), (PrimitiveId{50 + i, 10 + g, r % 2})) << r;
    ASSERT_EQ(scene.bounds(r).lo.x, double(i));
  }
}

TEST(Scene, OnlyInstancedScenesWidenTheirFilters) {
  SceneData data = one(triangles(corners(), {0, 1, 2}));
  EXPECT_EQ(Scene(data).world_frame().widen_per_org, 0.0);
  data.instances.push_back({0, 1, Affine::translation({1, 2, 3}), 1});
  const RayFrame frame = Scene(data).world_frame();
  EXPECT_GT(frame.widen_per_org, 0x1p-50);
  EXPECT_LT(frame.widen_per_org, 0x1p-40);
  EXPECT_GT(frame.widen_absolute, 0.0);
}

TEST(Scene, TheHashSeesGeometryAndInstancesButNotWarnings) {
  SceneData data = one(triangles(corners(), {0, 1, 2}));
  const std::uint64_t before = Scene(data).hash();
  data.warnings.push_back("noticed");
  EXPECT_EQ(Scene(data).hash(), before);
  data.instances.push_back({0, 1, Affine::translation({1, 0, 0}), 0});
  EXPECT_NE(Scene(data).hash(), before);
}

/// Meshes with and without refused triangles, spheres, all under two instances.
TEST(Scene, ManyAtOnceAreWhatTheyAreOneByOne) {
  SceneData data = one(triangles(corners(), {0, 1, 2, 0, 1, 1, 1, 2, 3}));
  data.geometries.push_back(triangles(corners(), {0, 1, 3, 0, 2, 3}));
  data.geometries.emplace_back().kind = PrimitiveKind::sphere;
  data.geometries.back().spheres = {{{0, 0, 0}, 1.0}, {{1, 2, 3}, 0.5}};
  data.instances = {{0, 3, {}, 0}, {0, 3, Affine::translation({1, 2, 3}), 1}, {1, 2, {}, 2}};
  const Scene scene(std::move(data));
  for (std::uint32_t first = 0; first < scene.size(); ++first)
    for (std::uint32_t count = 0; first + count <= scene.size(); ++count) {
      std::vector<Aabb> boxes(count);
      std::vector<std::uint32_t> references(count);
      std::vector<TriangleVertices> corners(count);
      for (std::uint32_t i = 0; i < count; ++i) references[i] = first + count - 1 - i;
      scene.bounds_from(first, boxes);
      scene.triangles(references, corners.data());
      for (std::uint32_t i = 0; i < count; ++i) {
        EXPECT_EQ(boxes[i], scene.bounds(first + i));
        TriangleVertices one;
        const bool is_triangle = scene.triangle(references[i], one);
        EXPECT_EQ(std::isnan(corners[i].b.y), !is_triangle);
        if (is_triangle) {
          EXPECT_EQ(corners[i].bounds(), one.bounds());
        }
      }
    }
}

TEST(Scene, KnowsWhetherItStoresFloats) {
  SceneData data = one(triangles(corners(), {0, 1, 2}));
  EXPECT_FALSE(Scene(data).stores_floats());
  data.geometries[0].mesh =
      make_mesh(std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
  EXPECT_TRUE(Scene(data).stores_floats());
}

TEST(Scene, AnEmptySceneHasNoReferences) {
  const Scene scene{SceneData{}};
  EXPECT_EQ(scene.size(), 0u);
  EXPECT_TRUE(scene.total_bounds().is_empty());
}

}  // namespace
}  // namespace strahl
