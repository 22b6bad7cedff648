#include <cmath>

#include <gtest/gtest.h>

#include <strahl/bounds/polytope.h>

namespace strahl {
namespace {

constexpr Aabb kCube{{-1, -1, -1}, {1, 1, 1}};

Polytope octahedron(Polytope::Use use = Polytope::Use::measure) {
  Polytope body(kCube, use);
  for (int i = 0; i < 8; ++i)
    body.add({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0}, 1.0);
  return body;
}

TEST(Polytope, MeasuresKnownBodies) {
  EXPECT_NEAR(Polytope(kCube).measure().half_area, 12.0, 1e-11);
  EXPECT_NEAR(Polytope(kCube).measure().volume, 8.0, 1e-11);
  EXPECT_NEAR(octahedron().measure().half_area, 2.0 * std::sqrt(3.0), 1e-11);
  EXPECT_NEAR(octahedron().measure().volume, 4.0 / 3.0, 1e-11);
  Polytope corner({{0, 0, 0}, {1, 1, 1}});
  corner.add({2, 2, 2}, 2.0);  // normals need not be unit
  EXPECT_NEAR(corner.measure().volume, 1.0 / 6, 1e-11);
  EXPECT_NEAR(corner.measure().half_area, 0.75 + std::sqrt(3.0) / 4, 1e-11);
}

TEST(Polytope, DoesNotMindPlanesThatRepeatOrDoNotCut) {
  Polytope body = octahedron();
  body.add({1, 1, 1}, 1.0), body.add({3, 3, 3}, 3.0), body.add({1, 0, 0}, 5.0);
  body.add({1, 0, 0}, 1.0), body.add({1, 2, 1}, 40.0);
  EXPECT_NEAR(body.measure().half_area, 2.0 * std::sqrt(3.0), 1e-11);
  body.add({1, 1, 1}, 0.5);  // a tighter one of the same direction
  EXPECT_LT(body.measure().volume, 1.3);
}

TEST(Polytope, OfAFlatBodyHasTwoSides) {
  Polytope plate({{0, 0, 2}, {3, 2, 2}});
  EXPECT_NEAR(plate.measure().half_area, 6.0, 1e-10);
  EXPECT_NEAR(plate.measure().volume, 0.0, 1e-10);
  Polytope slanted(kCube);
  slanted.add({1, 1, 0}, 0.0), slanted.add({-1, -1, 0}, 0.0);
  EXPECT_NEAR(slanted.measure().half_area, 4.0 * std::sqrt(2.0), 1e-9);
  const Polytope point({{5, 5, 5}, {5, 5, 5}});
  EXPECT_EQ(point.measure().half_area, 0.0);
}

TEST(Polytope, OfNothingMeasuresNothing) {
  Polytope none(kCube);
  none.add({1, 1, 1}, -9.0);
  EXPECT_EQ(none.measure().half_area, 0.0);
  EXPECT_EQ(none.measure().volume, 0.0);
  EXPECT_EQ(none.support({1, 0, 0}), -Aabb::kInf);
}

TEST(Polytope, HasCornersJustOutside) {
  EnclosedSet corners;
  octahedron(Polytope::Use::corners).add_corners_to(corners);
  for (const Vec3d& n : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1}}) {
    EXPECT_GT(corners.support(n), 1.0);
    EXPECT_LT(corners.support(n), 1.0 + 1e-11);
  }
  EXPECT_NEAR(octahedron().support({1, 2, 0}), 2.0, 1e-12);
}

}  // namespace
}  // namespace strahl
