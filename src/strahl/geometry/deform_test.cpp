// geometry/deform_test.cpp - a deformed scene is the scene that a file with those vertices gives.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/geometry/deform.h>

namespace strahl {
namespace {

const std::vector<Vec3d> kBefore{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
const std::vector<Vec3d> kAfter{{0, 0, 1}, {2, 0, 0}, {0, 3, 0}, {1, 1, 5}};

/// Two triangles and a ball, once as they are and once moved.
SceneData two(const std::vector<Vec3d>& vertices) {
  SceneData data;
  data.source = "two";
  data.geometries.resize(2);
  data.geometries[0].mesh = make_mesh(vertices, {0, 1, 2, 1, 3, 2});
  data.geometries[1].kind = PrimitiveKind::sphere;
  data.geometries[1].spheres = {{{3, 0, 0}, 1.0}};
  data.instances = {{0, 2, Affine{}, 4}, {0, 2, Affine::translation({9, 0, 0}), 7}};
  return data;
}

MovedVertices moved(const std::vector<Vec3d>& vertices, std::uint32_t geometry = 0) {
  const TriangleMesh mesh = make_mesh(vertices, {});
  return {geometry, mesh.vertices, mesh.keep_alive};
}

void expect_equal(const Scene& got, const Scene& expected) {
  EXPECT_EQ(got.hash(), expected.hash());
  EXPECT_EQ(got.to_object(), expected.to_object());
  ASSERT_EQ(got.size(), expected.size());
  for (std::uint32_t r = 0; r < expected.size(); ++r) {
    EXPECT_EQ(got.bounds(r), expected.bounds(r));
    EXPECT_EQ(got.id_of(r), expected.id_of(r));
  }
  EXPECT_EQ(got.total_bounds(), expected.total_bounds());
  EXPECT_EQ(got.counts().refused(), expected.counts().refused());
  for (std::uint32_t i = 0; i < expected.instances().size(); ++i)
    EXPECT_EQ(got.object_frame(i).bounds, expected.object_frame(i).bounds);
  EXPECT_EQ(got.world_frame().bounds, expected.world_frame().bounds);
  EXPECT_EQ(got.world_frame().widen_absolute, expected.world_frame().widen_absolute);
}

TEST(DeformedScene, IsAsIfLoadedSo) {
  const Scene base(two(kBefore));
  const std::vector<MovedVertices> change{moved(kAfter)};
  const Scene shaped = deformed(base, change);
  expect_equal(shaped, Scene(two(kAfter)));
  EXPECT_NE(shaped.hash(), base.hash());
  expect_equal(deformed(shaped, std::vector{moved(kBefore)}), base);
  expect_equal(deformed(base, {}), base);
}

TEST(DeformedScene, KeepsItsPoseAndCanBePosed) {
  const std::vector<Affine> maps{Affine::scaling({2, 2, 2}), Affine::translation({0, 5, 0})};
  SceneData data = two(kAfter);
  for (std::size_t i = 0; i < 2; ++i) data.instances[i].to_world = maps[i];
  const Scene expected(data), base(two(kBefore));
  const std::vector<MovedVertices> change{moved(kAfter)};
  expect_equal(deformed(base.posed(maps), change), expected);
  EXPECT_EQ(deformed(base, change).posed(maps).hash(), expected.hash());
}

TEST(DeformedScene, HasTheSameThings) {
  const Scene base(two(kBefore)), other(two(kBefore));
  const Scene shaped = deformed(base, std::vector{moved(kAfter)});
  EXPECT_TRUE(has_same_things(shaped, base) && has_same_things(base, deformed(shaped, {})));
  EXPECT_TRUE(has_same_things(base.posed(std::vector<Affine>(2)), shaped));
  EXPECT_FALSE(has_same_things(base, other)) << "other triangles in memory";
  SceneData more = base.data();
  more.instances.push_back(more.instances[0]);
  EXPECT_FALSE(has_same_things(base, Scene(more)));
  SceneData fewer = base.data();
  fewer.geometries[1].spheres.clear();
  EXPECT_FALSE(has_same_things(base, Scene(fewer)));
  SceneData renamed = base.data();
  renamed.instances[1].instance_id = 8;
  EXPECT_FALSE(has_same_things(base, Scene(renamed)));
}

TEST(DeformedScene, RefusesTrianglesThatBecomeHopelessAndTakesThemBack) {
  std::vector<Vec3d> flat = kBefore;
  flat[3] = {0.5, 0.5, 0};
  const Scene base(two(kBefore));
  const Scene collapsed = deformed(base, std::vector{moved(flat)});
  EXPECT_EQ(collapsed.counts().refused_zero_area, 1u);
  EXPECT_TRUE(collapsed.bounds(1).is_empty());
  flat[3].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(deformed(collapsed, std::vector{moved(flat)}).counts().refused_not_finite, 1u);
  expect_equal(deformed(collapsed, std::vector{moved(kBefore)}), base);
}

TEST(DeformedScene, OutlivesWhatItIsMadeOf) {
  auto base = std::make_unique<Scene>(two(kBefore));
  auto change = std::make_unique<std::vector<MovedVertices>>(1, moved(kAfter));
  const Scene shaped = deformed(*base, *change);
  base.reset(), change.reset();
  expect_equal(shaped, Scene(two(kAfter)));
}

std::string refusal(const MovedVertices& change) {
  try {
    const Scene shaped = deformed(Scene(two(kBefore)), {&change, 1});
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DeformedScene, NamesWhatDoesNotFit) {
  EXPECT_EQ(refusal(moved({{0, 0, 0}})), "two: geometry 0: 1 vertices for 4");
  EXPECT_EQ(refusal(moved(kAfter, 1)), "two: geometry 1: there are no triangles to deform");
  EXPECT_EQ(refusal(moved(kAfter, 2)), "two: geometry 2: there are no triangles to deform");
  std::vector<Vec3d> large = kAfter;
  large[2].x = 0x1p300;
  EXPECT_NE(refusal(moved(large)).find("vertex 2"), std::string::npos);
}

}  // namespace
}  // namespace strahl
