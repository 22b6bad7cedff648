// Areas of surfaces inside volumes against formulas.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/build/cut_piece.h>

namespace strahl {
namespace {

constexpr double kPi = std::numbers::pi;

/// An equilateral triangle of a plane z = height, far larger than what cuts it.
TriangleVertices sheet(double height, double reach = 20.0) {
  return {{-reach, -reach, height}, {reach, -reach, height}, {0.1, reach, height}};
}

double area_in(CutPiece piece, const std::vector<VolumeSide>& sides, double extent = 2.0) {
  piece.cut_to({sides, extent});
  return piece.area();
}

TEST(CutPiece, OfATriangleIsExactBetweenPlanes) {
  Rng rng(1);
  const auto point = [&] { return Vec3d{rng.uniform(), rng.uniform(), rng.uniform()}; };
  for (int i = 0; i < 300; ++i) {
    const TriangleVertices t{point(), point(), point()};
    const Aabb box = Aabb::join({point(), point()}, {Vec3d::all(0.4), Vec3d::all(0.6)});
    std::vector<VolumeSide> sides;
    SideList(sides).add(box);
    FlatPiece expected(t);
    expected.cut_to(box);
    EXPECT_NEAR(area_in(CutPiece(t), sides), expected.area(), 1e-13);
  }
}

TEST(CutPiece, InABallIsADisc) {
  for (const double height : {0.0, 0.3, 0.7, 0.95}) {
    const double disc = kPi * (1.0 - height * height);
    const double area = area_in(CutPiece(sheet(height)), {VolumeSide::ball({0, 0, 0}, 1.0)});
    EXPECT_NEAR(area, disc, 0.003 * kPi) << height;
    EXPECT_LE(area, disc) << height;
  }
  EXPECT_EQ(area_in(CutPiece(sheet(1.01)), {VolumeSide::ball({0, 0, 0}, 1.0)}), 0.0);
  const TriangleVertices small = sheet(0.0, 0.1);
  EXPECT_EQ(area_in(CutPiece(small), {VolumeSide::ball({0, 0, 0}, 1.0)}), CutPiece(small).area());
}

TEST(CutPiece, OutsideAHoleIsTheRest) {
  const TriangleVertices t = sheet(0.5, 3.0);
  const double disc = kPi * 0.75;
  EXPECT_NEAR(area_in(CutPiece(t), {VolumeSide::hole({0, 0, 0}, 1.0)}), CutPiece(t).area() - disc,
              0.003 * kPi);
}

TEST(CutPiece, InATubeIsAnEllipse) {
  for (const double angle : {0.0, 0.5, 1.0}) {
    const Vec3d axis{std::sin(angle), 0, std::cos(angle)};
    const double expected = kPi / std::cos(angle);
    EXPECT_NEAR(area_in(CutPiece(sheet(0.2)), {VolumeSide::tube({0, 0, 0}, axis, 1.0)}), expected,
                0.003 * expected);
  }
}

TEST(CutPiece, InAConeIsADisc) {
  for (const double cosine : {0.5, 0.8, 0.95}) {
    const double tangent = std::sqrt(1 - cosine * cosine) / cosine;
    const double expected = kPi * tangent * tangent;
    const auto cone = VolumeSide::cone({0, 0, 0}, {0, 0, 1}, cosine, 1.0 / cosine);
    EXPECT_NEAR(area_in(CutPiece(sheet(1.0)), {cone}), expected, 0.003 * expected) << cosine;
  }
}

TEST(CutPiece, GoesFromVolumeToVolume) {
  CutPiece piece(sheet(0.0));
  piece.cut_to({std::vector{VolumeSide::ball({0, 0, 0}, 1.0)}, 2.0});
  piece.cut_to({std::vector{VolumeSide::plane({0, 1, 0}, 0.0)}, 2.0});
  EXPECT_NEAR(piece.area(), 0.5 * kPi, 0.003 * kPi);
  piece.cut_to({std::vector{VolumeSide::ball({1, 0, 0}, 1.0)}, 2.0});
  // Half of what two unit discs at distance 1 share.
  EXPECT_NEAR(piece.area(), 0.5 * (2 * kPi / 3 - std::sqrt(0.75)), 0.003 * kPi);
  piece.cut_to({std::vector{VolumeSide::plane({0, 0, 1}, -1.0)}, 2.0});
  EXPECT_TRUE(piece.is_empty());
  EXPECT_EQ(piece.area(), 0.0);
}

TEST(CutPiece, IsTheSameWhereTheVolumeIsPlaced) {
  const Placement half(Affine::scaling(Vec3d::all(0.5)) * Affine::translation({-3, 0, 0}));
  CutPiece piece(sheet(0.0));
  piece.cut_to({std::vector{VolumeSide::ball({0, 0, 0}, 1.0)}, 2.0, &half});
  EXPECT_NEAR(piece.area(), 4.0 * kPi, 0.003 * 4.0 * kPi);  // around (3, 0, 0), of radius 2
  piece.cut_to({std::vector{VolumeSide::plane({1, 0, 0}, 0.0)}, 2.0, &half});  // x <= 3
  EXPECT_NEAR(piece.area(), 2.0 * kPi, 0.003 * 4.0 * kPi);
}

TEST(CutPiece, OfASphereInABallIsACap) {
  const CurvedSurface ball(Sphere{{0, 0, 0}, 1.0}, {});
  EXPECT_DOUBLE_EQ(CutPiece(ball).area(), 4.0 * kPi);
  for (const double distance : {0.4, 1.0, 1.6}) {
    const double cap = 2.0 * kPi * (1.0 - 0.5 * distance);
    EXPECT_NEAR(area_in(CutPiece(ball), {VolumeSide::ball({distance, 0, 0}, 1.0)}), cap,
                0.003 * 4.0 * kPi)
        << distance;
  }
  // In a ball much smaller than it, nearly a disc.
  EXPECT_NEAR(area_in(CutPiece(ball), {VolumeSide::ball({0, 0, 1}, 0.05)}, 0.1), kPi * 0.05 * 0.05,
              0.01 * kPi * 0.05 * 0.05);
}

TEST(CutPiece, OfACurvedThingAgreesWithThatOfBoxes) {
  Rng rng(2);
  const auto point = [&] { return Vec3d{rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform()}; };
  const CurvedSurface cone(Cone{{0, 0, 0}, 0.8, {0.1, 0.2, 1.0}, 0.3}, {});
  for (int i = 0; i < 50; ++i) {
    const Aabb box = Aabb::join({point(), point()}, {Vec3d::all(0.2), Vec3d::all(0.4)});
    std::vector<VolumeSide> sides;
    SideList(sides).add(box);
    CurvedPiece expected(cone);
    expected.cut_to(box);
    EXPECT_NEAR(area_in(CutPiece(cone), sides, norm_max(box.extent())), expected.area(),
                0.01 * CutPiece(cone).area());
  }
}

}  // namespace
}  // namespace strahl
