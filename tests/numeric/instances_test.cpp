// Instances: the hits are those of the ray carried into object space by the documented formula,
// tested exactly against every triangle there, however far away the ray begins. World boxes that
// were not widened by the rounding of that formula would lose some.
#include <algorithm>
#include <cmath>
#include <string>
#include <tests/numeric/rational.h>
#include <tests/numeric/solids.h>
#include <tests/support/queries.h>

#include <gtest/gtest.h>

#include <strahl/geometry/triangle.h>

namespace strahl::test {
namespace {

Vec3d random_point(Rng& rng, double reach) {
  const double x = rng.uniform(-reach, reach), y = rng.uniform(-reach, reach);
  return {x, y, rng.uniform(-reach, reach)};
}

/// Turned, stretched, sheared, half of them mirrored, spread over `reach`.
Affine random_map(Rng& rng, double reach) {
  const Vec3d axis = unit(random_point(rng, 1.0));
  const double half = rng.uniform(0.0, 3.0);
  const Vec3d q = std::sin(half) * axis;
  Affine shear;
  shear.m[0][1] = rng.uniform(-0.5, 0.5);
  const double mirror = rng.below(2) ? -1.0 : 1.0;
  return Affine::translation(random_point(rng, reach)) *
         Affine::rotation(q.x, q.y, q.z, std::cos(half)) * shear *
         Affine::scaling({mirror * rng.uniform(0.1, 3.0), rng.uniform(0.1, 3.0), 1.0});
}

struct Case {
  std::shared_ptr<const Scene> scene;
  std::vector<Ray> rays;
};

/// Rays from `distance` away past corners, edges and faces of random instances: off the mark by as
/// much as carrying such an origin into object space rounds, and mostly parallel to an axis, where
/// no relative margin of a box's planes makes up for that.
Case make_case(const TriangleMesh& mesh, std::size_t instances, double spread, double distance,
               std::size_t rays, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Affine> maps;
  while (maps.size() < instances) maps.push_back(random_map(rng, spread));
  Case c{scene_of(mesh, maps), {}};
  while (c.rays.size() < rays) {
    const TriangleVertices t = mesh[rng.below(static_cast<std::uint32_t>(mesh.size()))];
    const Vec3d targets[] = {t.a, 0.5 * (t.a + t.b), (t.a + t.b + t.c) / 3.0};
    const Affine& map = maps[rng.below(static_cast<std::uint32_t>(instances))];
    const double off = std::ldexp(distance + spread, -static_cast<int>(rng.below(8)) - 49);
    const Vec3d mark = map.point(targets[rng.below(3)]) + random_point(rng, off);
    Vec3d away = distance * unit(random_point(rng, 1.0));
    const int axis = static_cast<int>(rng.below(3));
    if (rng.below(4) != 0) away = {}, away[axis] = rng.below(2) ? distance : -distance;
    c.rays.push_back({mark + away, -0x1p-3 * away});
  }
  return c;
}

/// Row i = ((m0*x + m1*y) + m2*z) + m3, the direction without m3.
Vec3d carried(const Affine& map, const Vec3d& v, double w) {
  Vec3d image;
  for (int i = 0; i < 3; ++i) {
    const auto& row = map.m[static_cast<std::size_t>(i)];
    image[i] = (row[0] * v.x + row[1] * v.y) + row[2] * v.z;
    if (w != 0.0) image[i] += row[3];
  }
  return image;
}

/// The hits with t >= 0 in the order of hits, found in rational arithmetic in object space.
std::vector<PrimitiveId> expected_ids(const Scene& scene, const Ray& ray) {
  std::vector<std::pair<Rational, PrimitiveId>> hits;
  for (std::uint32_t i = 0; i < scene.instances().size(); ++i) {
    const Vec3d org = carried(scene.to_object()[i], ray.org, 1.0);
    const Vec3d dir = carried(scene.to_object()[i], ray.dir, 0.0);
    const TriangleMesh& mesh = scene.geometries().front().mesh;
    for (std::uint32_t k = 0; k < mesh.size(); ++k) {
      if (rational_crossing(org, dir, mesh[k]) == 0) continue;
      const RationalHit hit = rational_hit(org, dir, mesh[k]);
      const Rational t = hit.denominator == 0 ? Rational(0) : hit.numerator / hit.denominator;
      if (t >= 0) hits.push_back({t, {i, 0, k}});
    }
  }
  std::sort(hits.begin(), hits.end());
  std::vector<PrimitiveId> ids;
  for (const auto& [t, id] : hits) ids.push_back(id);
  return ids;
}

/// Rounded parameters may tie or swap where exact ones do not: as sets the ids must agree.
void expect_rational_hits(const Case& c) {
  std::vector<std::vector<PrimitiveId>> expected;
  for (const Ray& ray : c.rays) {
    expected.push_back(expected_ids(*c.scene, ray));
    std::sort(expected.back().begin(), expected.back().end());
  }
  for (const auto& structure : build_all(c.scene)) {
    SCOPED_TRACE(structure->spec());
    const AllHits all = all_hits(*structure, make_batch(c.rays));
    std::size_t found = 0;
    for (std::size_t i = 0; i < c.rays.size(); ++i) {
      std::vector<PrimitiveId> ids;
      for (const Hit& hit : hits_of(all, i)) ids.push_back(hit.id);
      found += ids.size();
      std::sort(ids.begin(), ids.end());
      ASSERT_EQ(ids, expected[i]) << "ray " << i;
    }
    EXPECT_GT(found, 20u);
  }
}

/// Bits of every query against brute force, which uses no world boxes.
void expect_bits_of_brute_force(const Case& c) {
  const auto brute = build(c.scene, "brute_force");
  const AllHits expected = all_hits(*brute, make_batch(c.rays));
  EXPECT_GT(expected.hits.size(), 100u);
  for (const auto& structure : build_all(c.scene)) {
    SCOPED_TRACE(structure->spec());
    const AllHits all = all_hits(*structure, make_batch(c.rays));
    const std::vector<Hit> closest = closest_hits(*structure, make_batch(c.rays));
    for (std::size_t i = 0; i < c.rays.size(); ++i) {
      const std::span<const Hit> got = hits_of(all, i), want = hits_of(expected, i);
      ASSERT_TRUE(std::equal(got.begin(), got.end(), want.begin(), want.end(),
                             [](const Hit& a, const Hit& b) { return same_bits(a, b); }))
          << "ray " << i;
      ASSERT_TRUE(same_bits(closest[i], want.empty() ? Hit{} : want.front())) << "ray " << i;
    }
  }
}

TEST(Instances, AnswerAsRationalArithmeticInObjectSpaceDoes) {
  const TriangleMesh mesh = as_mesh(integer_octahedron(3));
  for (const double distance : {1.0, 1e6, 1e12})
    expect_rational_hits(make_case(mesh, 12, 20.0, distance, 120, 1));
}

class InstancesFromAfar : public testing::TestWithParam<double> {};

TEST_P(InstancesFromAfar, LoseNoHitToWorldBoxes) {
  expect_bits_of_brute_force(
      make_case(as_mesh(integer_octahedron(3)), 60, 50.0, GetParam(), 3000, 2));
}
TEST_P(InstancesFromAfar, LoseNoHitOfThinAndTinyParts) {
  // Tiny and flat: their boxes are far smaller than the rounding of a distant origin.
  const TriangleMesh flat =
      make_mesh(std::vector<Vec3f>{{0, 0, 0}, {0x1p-20f, 0, 0}, {0, 0x1p-20f, 0}, {1, 1, 0}},
                {0, 1, 2, 1, 3, 2});
  expect_bits_of_brute_force(make_case(flat, 80, 3.0, GetParam(), 3000, 3));
}
TEST_P(InstancesFromAfar, LoseNoHitFarFromTheOrigin) {
  expect_bits_of_brute_force(make_case(as_mesh(integer_cube(1)), 40, 1e6, GetParam(), 1000, 4));
}

INSTANTIATE_TEST_SUITE_P(Distances, InstancesFromAfar, testing::Values(1.0, 1e3, 1e6, 1e9, 1e12),
                         [](const testing::TestParamInfo<double>& i) {
                           return "E" + std::to_string(static_cast<int>(std::log10(i.param)));
                         });

}  // namespace
}  // namespace strahl::test
