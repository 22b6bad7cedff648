#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/bounds/all_volumes.h>
#include <strahl/bounds/enclosed_set.h>
#include <strahl/bounds/fit.h>

namespace strahl {
namespace {

Vec3d random_point(Rng& rng) {
  const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1);
  return {x, y, rng.uniform(-1, 1)};
}

TEST(EnclosedSet, LeavesOutWhatCannotBeHit) {
  EnclosedSet set;
  set.add(Vec3d{0, NAN, 0});
  set.add(TriangleVertices{{0, 0, 0}, {1, 0, 0}, {0, Aabb::kInf, 0}});
  set.add(Sphere{{0, 0, 0}, -1.0});
  set.add(Sphere{{0, 0, 0}, 0.0});
  set.add(Cone{{0, 0, 0}, 1.0, {0, 0, 0}, 1.0});
  set.add(Aabb());
  EXPECT_TRUE(set.is_empty());
  EXPECT_FALSE(set.is_unbounded());
  set.add_corner({0, 0, Aabb::kInf});
  EXPECT_TRUE(set.is_unbounded());
  EXPECT_FALSE(set.is_empty());
}

TEST(EnclosedSet, HasExactBoxesAndSupportsJustOutside) {
  Rng rng(1);
  EnclosedSet set;
  Aabb box;
  std::vector<Vec3d> points;
  for (int i = 0; i < 100; ++i) {
    points.push_back(1e6 * random_point(rng));
    box.extend(points.back());
    set.add(points.back());
  }
  EXPECT_EQ(set.box(), box);
  for (int i = 0; i < 100; ++i) {
    const Vec3d n = random_point(rng);
    long double most = -1e30L;
    for (const Vec3d& p : points)
      most =
          std::max(most, static_cast<long double>(n.x) * p.x + static_cast<long double>(n.y) * p.y +
                             static_cast<long double>(n.z) * p.z);
    EXPECT_GE(static_cast<long double>(set.support(n)), most);
    EXPECT_LE(set.support(n), static_cast<double>(most) + 1e-8);
    EXPECT_EQ(set.extent(-n).first, -set.support(n));
  }
}

TEST(EnclosedSet, KnowsDistancesFromTriangles) {
  const TriangleVertices tri{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  EXPECT_DOUBLE_EQ(distance_to(tri, {1, 1, 3}), 3.0);
  EXPECT_DOUBLE_EQ(distance_to(tri, {-3, -4, 0}), 5.0);
  EXPECT_DOUBLE_EQ(distance_to(tri, {2, -2, 0}), 2.0);
  EXPECT_DOUBLE_EQ(distance_to(tri, {4, 4, 1}), 3.0);
  EXPECT_DOUBLE_EQ(distance_to({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {1, 1, 3}), 2.0);
  Rng rng(2);
  for (int round = 0; round < 200; ++round) {
    const double flat = std::ldexp(1.0, -round % 30);
    const Vec3d a = random_point(rng), b = random_point(rng);
    const TriangleVertices t{a, b, 0.5 * (a + b) + flat * random_point(rng)};
    const Vec3d from = 2.0 * random_point(rng);
    const double distance = distance_to(t, from);
    double least = Aabb::kInf;
    for (int i = 0; i <= 60; ++i)
      for (int j = 0; i + j <= 60; ++j)
        least = std::min(least,
                         length(t.a + (i / 60.0) * (t.b - t.a) + (j / 60.0) * (t.c - t.a) - from));
    EXPECT_LE(distance, least * (1 + 1e-12));
    EXPECT_GE(distance, least - 0.1);
  }
}

TEST(EnclosedSet, KnowsItsHole) {
  EnclosedSet set;
  EXPECT_EQ(set.nearest_to({0, 0, 0}), Aabb::kInf);
  set.add(Sphere{{0, 0, 0}, 2.0});
  EXPECT_NEAR(set.nearest_to({0, 0, 0}), 2.0, 1e-6);
  EXPECT_NEAR(set.nearest_to({0, 0, 1.5}), 0.5, 1e-6);
  EXPECT_NEAR(set.nearest_to({0, 0, 5}), 3.0, 1e-6);
  EXPECT_LE(set.nearest_to({0, 0, 5}), 3.0);
  set.add(Cone{{0, 0, -1}, 0.25, {0, 0, 1}, 0.25});
  EXPECT_EQ(set.nearest_to({0, 0, 0}), 0.0);  // inside a cone counts as in it
  set.add_corner({9, 9, 9});
  EXPECT_EQ(set.nearest_to({0, 0, 5}), 0.0);
}

/// Points of the lateral surface, and how far rims reach.
TEST(EnclosedSet, GoesAroundCones) {
  Rng rng(3);
  for (int round = 0; round < 300; ++round) {
    const double slim = std::ldexp(1.0, -round % 20);
    const Vec3d base = random_point(rng);
    const Cone cone{base, rng.uniform(), base + slim * random_point(rng), rng.uniform()};
    EnclosedSet set;
    set.add(cone);
    const Basis basis(cone.apex - cone.base);
    for (int i = 0; i < 20; ++i) {
      const Vec3d n = i == 0 ? basis.w : i == 1 ? basis.u : random_point(rng);
      const double around = std::hypot(dot(basis.u, n), dot(basis.v, n));
      const double reach = std::max(dot(n, cone.base) + cone.base_radius * around,
                                    dot(n, cone.apex) + cone.apex_radius * around);
      EXPECT_GE(set.support(n), reach);
      if (slim == 1.0) {
        EXPECT_LE(set.support(n), reach + 0.02);
      }
    }
    EXPECT_EQ(set.box(), bounds(cone));
  }
}

/// Canonical hits lie off a cone by rounding that grows as it gets flatter. Where the polygons
/// touch the rims nothing but the inflation, and the box of the flattest, keeps them inside.
TEST(EnclosedSet, HoldsTheHitsOnCones) {
  Rng rng(4);
  std::size_t hits = 0;
  for (int round = 0; round < 600; ++round) {
    const double r0 = rng.uniform(), r1 = rng.uniform();
    const Vec3d base = random_point(rng), axis = unit(random_point(rng));
    const Cone cone{base, r0, base + std::ldexp(std::abs(r1 - r0), -round % 24) * axis, r1};
    EnclosedSet set;
    set.add(cone);
    const Vec3d span = cone.apex - cone.base;
    const Basis basis(span);
    for (int i = 0; i < 24; ++i) {
      const double angle = (i + 0.5) * std::numbers::pi / 12, part = i % 3 * 0.5;
      const Vec3d out = std::cos(angle) * basis.u + std::sin(angle) * basis.v;
      // Across the surface, and across the rim.
      const Vec3d n = i % 2 == 0 ? unit(length(span) * out - (r1 - r0) * basis.w) : out;
      const Vec3d slope = unit(span + (r1 - r0) * out), side = cross(basis.w, out);
      const Vec3d target = base + part * span + (r0 + part * (r1 - r0)) * out;
      const Vec3d dir = i % 4 < 2 ? random_point(rng) : slope + rng.uniform(-1, 1) * side;
      const Vec3d org = target - dir;
      const CurvedHits tied = tie_to_box(intersect(cone, org, dir), org, dir, bounds(cone));
      for (int h = 0; h < tied.count; ++h) {
        const double t = tied.hit[static_cast<std::size_t>(h)].t;
        long double reach = 0.0L;
        for (int k = 0; k < 3; ++k)
          reach += static_cast<long double>(n[k]) * (org[k] + static_cast<long double>(t) * dir[k]);
        EXPECT_LE(static_cast<double>(reach - set.support(n)), 0x1p-44) << "flat " << round % 24;
        ++hits;
      }
    }
  }
  EXPECT_GT(hits, 5000u);
}

TEST(EnclosedSet, PlacesWhatLiesUnderInstances) {
  SceneData data;
  data.geometries.resize(2);
  data.geometries[0].mesh =
      make_mesh(std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
  data.geometries[1].kind = PrimitiveKind::sphere;
  data.geometries[1].spheres = {{{0, 0, 0}, 1.0}, {{0, 0, 0}, -1.0}};
  Affine up = Affine::translation({0, 0, 5}) * Affine::scaling({2, 2, 1});
  data.instances = {{0, 2, {}, 0}, {0, 2, up, 1}};
  const Scene scene(std::move(data));
  ASSERT_EQ(scene.size(), 6u);
  const auto box_of = [&](std::uint32_t reference) {
    EnclosedSet set;
    set.add(scene, reference);
    return set.box();
  };
  EXPECT_EQ(box_of(0), (Aabb{{0, 0, 0}, {1, 1, 0}}));
  EXPECT_EQ(box_of(1), (Aabb{{-1, -1, -1}, {1, 1, 1}}));
  EXPECT_TRUE(box_of(2).is_empty());
  EXPECT_EQ(box_of(3), (Aabb{{0, 0, 5}, {2, 2, 5}}));
  for (const std::uint32_t reference : {0u, 1u, 3u, 4u})
    EXPECT_EQ(box_of(reference), scene.bounds(reference));
  EnclosedSet sphere, ellipsoid;
  sphere.add(scene, 1), ellipsoid.add(scene, 4);
  EXPECT_EQ(sphere.balls().size(), 1u);
  EXPECT_EQ(ellipsoid.points().size(), 8u);
}

TEST(EnclosedSet, AppendsAll) {
  EnclosedSet a, b;
  a.add(Vec3d{1, 0, 0});
  b.add(TriangleVertices{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  b.add(Sphere{{5, 0, 0}, 1.0});
  a.append(b);
  EXPECT_EQ(a.points().size(), 4u);
  EXPECT_EQ(a.balls().size(), 1u);
  EXPECT_EQ(a.box(), (Aabb{{0, -1, -1}, {6, 1, 1}}));
  EXPECT_NEAR(a.nearest_to({-3, 0, 0}), 3.0, 1e-5);  // the triangle's own corner
}

}  // namespace
}  // namespace strahl
