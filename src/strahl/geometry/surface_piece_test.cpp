#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/geometry/surface_piece.h>

namespace strahl {
namespace {

constexpr double kPi = std::numbers::pi, kInf = Aabb::kInf;
const Aabb kAll{Vec3d::all(-kInf), Vec3d::all(kInf)};

template <class Piece>
double area_in(Piece piece, const Aabb& box) {
  piece.cut_to(box);
  return piece.area();
}

/// A map that stretches, turns and moves.
Affine skew_map() {
  const double h = std::sqrt(0.5);
  return Affine::translation({3, -2, 5}) * Affine::rotation(0.5 * h, 0.5 * h, -0.5 * h, h + 0.1) *
         Affine::scaling({2.0, 0.7, 1.3});
}

TEST(FlatPiece, IsCutExactly) {
  const FlatPiece triangle({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}});
  EXPECT_EQ(triangle.area(), 8.0);
  EXPECT_EQ(area_in(triangle, kAll), 8.0);
  EXPECT_EQ(area_in(triangle, {{0, 0, 0}, {1, 1, 0}}), 1.0);
  EXPECT_EQ(area_in(triangle, {{1, 1, -1}, {9, 9, 1}}), 2.0);
  EXPECT_EQ(area_in(triangle, {{0, 0, 1}, {9, 9, 2}}), 0.0);
  // All six planes: a hexagon of the triangle x + y + z = 3 in [0,2]^3.
  const FlatPiece slanted({{3, 0, 0}, {0, 3, 0}, {0, 0, 3}});
  EXPECT_NEAR(area_in(slanted, {{0, 0, 0}, {2, 2, 2}}), slanted.area() * (1.0 - 3.0 / 9.0), 1e-12);
}

TEST(FlatPiece, PartsOfABoxAddUp) {
  Rng rng(1);
  const auto point = [&] { return Vec3d{rng.uniform(), rng.uniform(), rng.uniform()}; };
  for (int k = 0; k < 200; ++k) {
    const FlatPiece triangle({point(), point(), point()});
    const Vec3d at = point();
    double sum = 0.0;
    for (int octant = 0; octant < 8; ++octant) {
      Aabb box{Vec3d::all(-1), Vec3d::all(2)};
      for (int axis = 0; axis < 3; ++axis) (octant >> axis & 1 ? box.lo : box.hi)[axis] = at[axis];
      sum += area_in(triangle, box);
    }
    EXPECT_NEAR(sum, triangle.area(), 1e-12);
  }
}

TEST(CurvedPiece, HasTheAreaOfTheFormulas) {
  const CurvedSurface ball(Sphere{{1, 2, 3}, 2.0}, {});
  EXPECT_NEAR(CurvedPiece(ball).area(), 16.0 * kPi, 1e-12);
  const CurvedSurface cone(Cone{{1, 0, 0}, 3.0, {1, 0, 4}, 0.0}, {});
  EXPECT_NEAR(CurvedPiece(cone).area(), kPi * 3.0 * 5.0, 1e-12);
  const CurvedSurface tube(Cone{{0, 0, 0}, 2.0, {3, 4, 0}, 2.0}, {});
  EXPECT_NEAR(CurvedPiece(tube).area(), 2.0 * kPi * 2.0 * 5.0, 1e-12);
}

TEST(CurvedPiece, OfASphereIsACap) {
  const CurvedSurface ball(Sphere{{1, 2, 3}, 2.0}, {});
  for (const double height : {0.1, 0.5, 1.0, 2.0, 3.3})
    for (int axis = 0; axis < 3; ++axis) {
      Aabb box{{-1, 0, 1}, {3, 4, 5}};
      box.lo[axis] = box.hi[axis] - height;
      EXPECT_NEAR(area_in(CurvedPiece(ball), box), 2.0 * kPi * 2.0 * height, 0.003 * 16.0 * kPi)
          << height << ' ' << axis;
    }
}

TEST(CurvedPiece, UnderAMapHasTheAreaOfItsImage) {
  const Affine doubled = Affine::scaling({2, 2, 2});
  const CurvedSurface ball(Sphere{{1, 2, 3}, 2.0}, doubled);
  EXPECT_NEAR(CurvedPiece(ball).area(), 64.0 * kPi, 1e-9);
  // A prolate spheroid of half axes 1, 1, 2.
  const CurvedSurface egg(Sphere{{0, 0, 0}, 1.0}, Affine::scaling({1, 2, 1}));
  const double e = std::sqrt(0.75);
  const double area = 2.0 * kPi * (1.0 + 2.0 / e * std::asin(e));
  EXPECT_NEAR(CurvedPiece(egg).area(), area, 0.001 * area);
  EXPECT_NEAR(area_in(CurvedPiece(egg), {{-1, -2, -1}, {0, 2, 1}}), area / 2, 0.002 * area);
}

/// A point of the surface, uniform by area.
Vec3d random_point(const Sphere& s, Rng& rng) {
  const double z = rng.uniform(-1, 1), v = rng.uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
  return s.center + s.radius * Vec3d{r * std::cos(v), r * std::sin(v), z};
}
/// Of a cone along x.
Vec3d random_point(const Cone& c, Rng& rng) {
  double u, radius;
  do {
    u = rng.uniform(), radius = c.base_radius + u * (c.apex_radius - c.base_radius);
  } while (rng.uniform(0, std::max(c.base_radius, c.apex_radius)) > radius);
  const double v = rng.uniform(0, 2 * kPi);
  return c.base + u * (c.apex - c.base) + Vec3d{0, radius * std::cos(v), radius * std::sin(v)};
}

template <class Shape>
void expect_like_points(const Shape& shape, const Aabb& around, Rng& rng) {
  const CurvedSurface surface(shape, {});
  const double whole = CurvedPiece(surface).area();
  constexpr int kPoints = 20000;
  for (int k = 0; k < 20; ++k) {
    Aabb box;
    for (int i = 0; i < 2; ++i) {
      const double x = rng.uniform(), y = rng.uniform();
      const Vec3d e = around.extent();
      box.extend(around.lo + Vec3d{x * e.x, y * e.y, rng.uniform() * e.z});
    }
    int inside = 0;
    for (int i = 0; i < kPoints; ++i) inside += box.contains(random_point(shape, rng));
    EXPECT_NEAR(area_in(CurvedPiece(surface), box), whole * inside / kPoints, 0.015 * whole);
  }
}

TEST(CurvedPiece, AgreesWithRandomPoints) {
  Rng rng(2);
  expect_like_points(Sphere{{1, 2, 3}, 2.0}, {{-1.5, -0.5, 0.5}, {3.5, 4.5, 5.5}}, rng);
  expect_like_points(Cone{{1, 0, 0}, 3.0, {5, 0, 0}, 0.0}, {{0, -3, -3}, {6, 3, 3}}, rng);
  expect_like_points(Cone{{1, 0, 0}, 0.5, {9, 0, 0}, 0.5}, {{0, -1, -1}, {10, 1, 1}}, rng);
}

TEST(CurvedPiece, SeesPlanesOfBoxesMuchLargerThanItself) {
  const CurvedSurface ball(Sphere{{1, 2, 3}, 0.5}, {});
  const CurvedSurface tube(Cone{{-3, 2, 3}, 0.1, {5, 2, 3}, 0.1}, {});
  const double sphere = kPi, rod = 0.2 * kPi * 8.0;
  for (const double size : {2.0, 30.0, 1e4}) {
    const Aabb eighth{{1, 2, 3}, {1 + size, 2 + size, 3 + size}};
    EXPECT_NEAR(area_in(CurvedPiece(ball), eighth), sphere / 8, 0.001 * sphere) << size;
    const Aabb cap{{1.3, -size, -size}, {size + 4, size + 4, size + 4}};
    EXPECT_NEAR(area_in(CurvedPiece(ball), cap), sphere / 5, 0.001 * sphere) << size;
    const Aabb half{{-size - 4, 2, -size}, {size + 4, size + 4, size + 4}};
    EXPECT_NEAR(area_in(CurvedPiece(tube), half), rod / 2, 0.001 * rod) << size;
  }
}

TEST(CurvedPiece, SeesBoxesMuchSmallerThanItself) {
  const CurvedSurface ball(Sphere{{0, 0, 0}, 1000.0}, {});
  const double side = 0.01;
  const Vec3d at = 1000.0 * unit(Vec3d{1, 0, 0});
  const Aabb box{at - Vec3d::all(side / 2), at + Vec3d::all(side / 2)};
  EXPECT_NEAR(area_in(CurvedPiece(ball), box), side * side, 0.01 * side * side);
}

TEST(CurvedSurface, PatchesLieWithinTheirReach) {
  Rng rng(3);
  const std::vector<CurvedSurface> surfaces{{Sphere{{1, 2, 3}, 2.0}, Affine{}},
                                            {Sphere{{1, 2, 3}, 2.0}, skew_map()},
                                            {Cone{{1, 0, 0}, 3.0, {2, 5, 1}, 0.5}, Affine{}},
                                            {Cone{{1, 0, 0}, 0.0, {2, 5, 1}, 4.0}, skew_map()}};
  for (const CurvedSurface& surface : surfaces)
    for (int k = 0; k < 2000; ++k) {
      Patch patch = surface.whole();
      for (std::uint32_t depth = rng.below(8); depth > 0; --depth)
        patch = surface.halves(patch)[rng.below(2)];
      const double u = rng.uniform(patch.u0, patch.u1), v = rng.uniform(patch.v0, patch.v1);
      const Vec3d point = surface.middle({u, u, v, v});
      ASSERT_LE(length(point - surface.middle(patch)), surface.reach(patch) * (1 + 1e-12));
    }
}

TEST(VisitSurface, PlacesWhatInstancesPlace) {
  SceneData data;
  Geometry balls, flat;
  balls.kind = PrimitiveKind::sphere;
  balls.spheres = {{{0, 0, 0}, 1.0}};
  flat.mesh = make_mesh(std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
  data.geometries = {balls, flat};
  data.instances = {{0, 2, Affine::scaling({3, 3, 3}), 1}, {0, 2, Affine{}, 2}};
  const Scene scene(std::move(data));
  const auto area = [&](std::uint32_t i) {
    return visit_surface(scene, i, [](const auto& piece) { return piece.area(); });
  };
  EXPECT_NEAR(area(0), 36.0 * kPi, 1e-9);
  EXPECT_NEAR(area(1), 4.5, 1e-12);
  EXPECT_NEAR(area(2), 4.0 * kPi, 1e-9);
  EXPECT_NEAR(area(3), 0.5, 1e-12);
}

}  // namespace
}  // namespace strahl
