// catalog/update_test.cpp - accelerators that follow deforming scenes: the bits of one built anew.
#include <cmath>
#include <tests/support/against_brute.h>
#include <tests/support/mesh_maker.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/geometry/deform.h>

namespace strahl {

namespace test {
namespace {

/// A cloth of n x n squares.
MeshMaker cloth(int n) {
  MeshMaker mesh;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) mesh.vertices.push_back({x * 1.0 / n, y * 1.0 / n, 0});
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const auto at = [&](int dx, int dy) {
        return static_cast<std::uint32_t>((y + dy) * (n + 1) + x + dx);
      };
      mesh.indices.insert(mesh.indices.end(),
                          {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)});
    }
  return mesh;
}

std::vector<MovedVertices> waved(const MeshMaker& mesh, double phase, double height) {
  std::vector<Vec3f> moved;
  for (const Vec3d& v : mesh.vertices)
    moved.push_back(Vec3f(v + Vec3d{0.1 * std::sin(9 * v.y + phase), 0,
                                    height * std::sin(7 * v.x + phase) * std::cos(5 * v.y)}));
  const TriangleMesh own = make_mesh(std::move(moved), {});
  return {{0, own.vertices, own.keep_alive}};
}

/// The cloth, once as it is and once turned.
ScenePtr cloth_scene(const MeshMaker& mesh) {
  SceneData data;
  data.source = "cloth";
  data.geometries = {mesh.geometry()};
  data.instances = {
      {0, 1, Affine{}, 0},
      {0, 1, Affine::translation({0.3, 0, 0.4}) * Affine::rotation(0.3, 0.1, 0.2, 0.927), 1}};
  return std::make_shared<const Scene>(std::move(data));
}

std::vector<Ray> rays_for(const Scene& scene) {
  std::vector<Vec3d> points;
  for (std::uint32_t i = 0; i < scene.size(); ++i)
    if (const Aabb box = scene.bounds(i); !box.is_empty()) points.push_back(box.center());
  return rays_through(points, scene.total_bounds(), 20, 5);
}

void expect_same(const Accelerator& moved, const std::shared_ptr<const Scene>& scene) {
  ASSERT_NO_THROW(moved.validate());
  EXPECT_EQ(&moved.scene(), scene.get());
  const std::vector<Ray> rays = rays_for(*scene);
  const RayBatch batch = make_batch(rays);
  for (const char* spec : {"bvh", "brute_force"}) {
    const auto anew = build(scene, spec);
    const AllHits got = all_hits(moved, batch), expected = all_hits(*anew, batch);
    ASSERT_EQ(got.splits, expected.splits);
    for (std::size_t i = 0; i < got.hits.size(); ++i)
      ASSERT_TRUE(same_bits(got.hits[i], expected.hits[i])) << i;
    const auto first = closest_hits(moved, batch), nearest = closest_hits(*anew, batch);
    for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_TRUE(same_bits(first[i], nearest[i])) << i;
    EXPECT_EQ(hit_counts(moved, batch), hit_counts(*anew, batch));
  }
}

TEST(Update, EveryFrameOfADeformingMeshHasTheBitsOfOneBuiltAnew) {
  const MeshMaker mesh = cloth(10);
  const ScenePtr rest = cloth_scene(mesh);
  for (const char* spec :
       {"bvh", "bvh:rebuild_factor=1", "bvh:bv=sphere,traversal=heap,rebuild_factor=100",
        "bvh:builder=spatial,duplicates=1,rebuild_factor=100", "bvh:arity=8,bv=auto", "wide_bvh",
        "wide_bvh:rebuild_factor=1", "wide_bvh:width=8,rebuild_factor=100",
        "wide_bvh:quality=high,rebuild_factor=100", "wide_bvh:layout=compact,rebuild_factor=100"}) {
    SCOPED_TRACE(spec);
    const auto bvh = build(rest, spec);
    for (int frame = 0; frame < 4; ++frame) {
      const auto scene =
          std::make_shared<const Scene>(deformed(*rest, waved(mesh, frame, 0.1 * frame)));
      bvh->update(scene, {});
      expect_same(*bvh, scene);
    }
  }
}

TEST(Update, FollowsPosesAndShapesTogether) {
  const MeshMaker mesh = cloth(8);
  const ScenePtr rest = cloth_scene(mesh);
  for (const char* spec : {"bvh", "wide_bvh"}) {
    const auto bvh = build(rest, spec);
    for (int frame = 0; frame < 4; ++frame) {
      const std::vector<Affine> maps{Affine::translation({0.1 * frame, 0, 0}),
                                     Affine::rotation(0, 0, 0.1 * frame, 1)};
      const auto scene =
          std::make_shared<const Scene>(deformed(rest->posed(maps), waved(mesh, frame, 0.2)));
      bvh->update(scene, {});
      expect_same(*bvh, scene);
    }
  }
}

TEST(Update, FollowsTrianglesThatVanishAndComeBack) {
  const MeshMaker mesh = cloth(8);
  const ScenePtr rest = cloth_scene(mesh);
  for (const char* spec : {"bvh:rebuild_factor=1000", "wide_bvh:rebuild_factor=1000",
                           "wide_bvh:layout=compact,rebuild_factor=1000"}) {
    const auto bvh = build(rest, spec);
    for (const std::size_t flat : {3u, 9u, 0u}) {
      MeshMaker folded = mesh;
      for (std::size_t i = 0; i < flat; ++i) folded.vertices[i] = folded.vertices[flat];
      const auto scene = std::make_shared<const Scene>(deformed(*rest, waved(folded, 0, 0.1)));
      EXPECT_EQ(scene->counts().refused() > 0, flat > 0);
      bvh->update(scene, {});
      expect_same(*bvh, scene);
    }
  }
}

ErrorCode code_of(Accelerator& accelerator, const ScenePtr& scene) {
  try {
    accelerator.update(scene, {});
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "accepted";
  return ErrorCode::usage;
}

TEST(Update, IsRefusedWhereItCannotBe) {
  const MeshMaker mesh = cloth(4);
  const ScenePtr rest = cloth_scene(mesh);
  const auto waves = std::make_shared<const Scene>(deformed(*rest, waved(mesh, 1, 0.1)));
  EXPECT_EQ(code_of(*build(rest, "two_level"), waves), ErrorCode::unsupported);
  EXPECT_EQ(code_of(*build(rest, "kd_tree"), waves), ErrorCode::unsupported);
  EXPECT_EQ(code_of(*build(rest, "bvh"), cloth_scene(mesh)), ErrorCode::usage);
}

}  // namespace
}  // namespace test
}  // namespace strahl
