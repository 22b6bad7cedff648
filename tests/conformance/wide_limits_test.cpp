// wide_bvh where rays cross triangles exactly at their limits, or as near as floats are: what
// packets and flights decide in doubles.
#include <cmath>
#include <limits>
#include <random>
#include <tests/conformance/float_ray_set.h>
#include <tests/conformance/forced_isa.h>

#include <gtest/gtest.h>

namespace strahl::test {
namespace {

struct Corner {
  Vec3d a, ab, ac;
  Vec3d at(double u, double v) const { return a + u / 8 * ab + v / 8 * ac; }
};

/// Brings integers into a size for which trees keep a scene's coordinates.
constexpr double kUnit = 0x1p-10;

/// Of integers of 23 bits, so that points between the corners are floats that lie exactly in the
/// plane, while its equation is rounded in doubles.
std::vector<Corner> some_corners() {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> steps(-(1 << 19), 1 << 19);
  const auto some = [&](double step) {
    return step * Vec3d{double(steps(random)), double(steps(random)), double(steps(random))};
  };
  std::vector<Corner> corners(60);
  for (Corner& c : corners) c = {some(8 * kUnit), some(8 * kUnit), some(8 * kUnit)};
  return corners;
}

std::shared_ptr<const Scene> scene_of(const std::vector<Corner>& corners) {
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (const Corner& c : corners)
    for (const Vec3d& v : {c.a, c.a + c.ab, c.a + c.ac})
      indices.push_back(static_cast<std::uint32_t>(vertices.size())), vertices.push_back(v);
  Geometry geometry;
  geometry.mesh = make_mesh(std::move(vertices), std::move(indices));
  SceneData data;
  data.geometries.push_back(std::move(geometry));
  return std::make_shared<const Scene>(std::move(data));
}

/// A block of rays that cross a triangle's inside exactly at t, or in all directions there.
void add_block(const Corner& corner, double t, float t_min, float t_max, bool all_ways,
               FloatRaySet& rays) {
  for (int i = 0; i < 64; ++i) {
    const double side = all_ways && i % 2 != 0 ? -kUnit : kUnit;
    const Vec3d dir = side * Vec3d{double(3 + i % 5), double(1 + i % 2), double(2 + i % 4)};
    const Vec3d org = corner.at(1 + i % 3, 1 + i / 3 % 4) - t * dir;
    rays.records.push_back({Vec3f(org), t_min, Vec3f(dir), t_max});
  }
}

FloatRaySet rays_to(const std::vector<Corner>& corners) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  FloatRaySet rays;
  for (const Corner& c : corners)
    for (const bool all_ways : {false, true}) {
      add_block(c, 0.0, 0.0f, kInf, all_ways, rays);
      add_block(c, 8.0, 0.0f, 8.0f, all_ways, rays);
      add_block(c, 8.0, 0.0f, std::nextafter(8.0f, 0.0f), all_ways, rays);
      add_block(c, 8.0, 8.0f, kInf, all_ways, rays);
      add_block(c, 8.0, std::nextafter(8.0f, 9.0f), kInf, all_ways, rays);
      add_block(c, 8.0, 0.0f, 7.99f, all_ways, rays),
          add_block(c, 8.0, 8.01f, kInf, all_ways, rays);
    }
  return rays;
}

TEST(WideLimits, HitsExactlyThereCountAsWithBvh) {
  const std::vector<Corner> corners = some_corners();
  const FloatRaySet rays = rays_to(corners);
  for (const std::string& isa : isas()) {
    SCOPED_TRACE(isa);
    const ForcedIsa forced(isa.c_str());
    expect_like_bvh(scene_of(corners), rays, {"wide_bvh", "wide_bvh:batch=single"});
  }
}

}  // namespace
}  // namespace strahl::test
