// Boxes of instances are widened enough: the ray that an instance sees is rounded, so it may hit
// where the world's ray passes by the world's box.
#include <cmath>
#include <tests/conformance/oracle.h>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>

namespace strahl::test {
namespace {

std::shared_ptr<const Scene> turned_octahedron(const Vec3d& center, Rng& rng) {
  SceneData data;
  std::vector<Vec3d> corners{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t a = i & 1 ? 0 : 3, b = i & 2 ? 1 : 4, c = i & 4 ? 2 : 5;
    triangles.insert(triangles.end(), {a, b, c});
  }
  data.geometries.emplace_back().mesh = make_mesh(std::move(corners), std::move(triangles));
  const Vec3d q = normalized(Vec3d{rng.uniform(), rng.uniform(), rng.uniform()});
  const double angle = 3 * rng.uniform(), s = std::sin(angle);
  const Affine turn = Affine::rotation(s * q.x, s * q.y, s * q.z, std::cos(angle));
  data.instances = {{0, 1, Affine::translation(center) * turn, 0}};
  return std::make_shared<const Scene>(std::move(data));
}

/// Rays along x at the height of the scene's top, shifted by a few roundings of `unit`.
std::vector<Ray> over_the_top(const Scene& scene, double from_x, double unit, Rng& rng) {
  const Aabb& box = scene.total_bounds();
  Vec3d top;
  for (const Vec3d& corner : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
    for (const double sign : {-1.0, 1.0}) {
      const Vec3d p = scene.instances()[0].to_world.point(sign * corner);
      if (p.z == box.hi.z) top = p;
    }
  std::vector<Ray> rays;
  for (int i = 0; i < 300; ++i) {
    const double shift = std::ldexp(unit, -53) * (8 * rng.uniform() - 2);
    rays.push_back({{from_x, top.y, top.z + shift}, {1, 0, 0}});
  }
  return rays;
}

void expect_widened(const Vec3d& center, double from_x, double unit) {
  Rng rng(5);
  int beside_the_box = 0;
  for (int turn = 0; turn < 60; ++turn) {
    const auto scene = turned_octahedron(center, rng);
    const std::vector<Ray> rays = over_the_top(*scene, from_x, unit, rng);
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    build(scene, "brute_force")->closest_hit(make_batch(rays), expected);
    for (std::size_t i = 0; i < rays.size(); ++i)
      beside_the_box += expected[i].is_hit() && rays[i].org.z > scene->total_bounds().hi.z;
    for (const StructureEntry& entry : all_structures()) {
      build(scene, entry.name)->closest_hit(make_batch(rays), hits);
      for (std::size_t i = 0; i < rays.size(); ++i)
        ASSERT_TRUE(have_same_bits(hits[i], expected[i])) << entry.name << " ray " << i;
    }
  }
  EXPECT_GT(beside_the_box, 100) << "the rays must be hard";
}

TEST(Widening, CoversTheRoundingOfFarOrigins) { expect_widened({0, 0, 0}, -1e12, 1e12); }

TEST(Widening, CoversTheRoundingOfFarInstances) { expect_widened({1e9, 0, 0}, 0.0, 1e9); }

}  // namespace
}  // namespace strahl::test
