#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/bounds/minimal_ball.h>

// The comparison with CGAL is tests/numeric/bounds_cgal_test.cpp.
namespace strahl {
namespace {

void expect_ball(const Ball& ball, const Vec3d& center, double radius) {
  EXPECT_LE(length(ball.center - center), 1e-14);
  EXPECT_NEAR(ball.radius, radius, 1e-14);
}

TEST(MinimalBall, OfFewPoints) {
  expect_ball(minimal_ball({}), {0, 0, 0}, 0.0);
  expect_ball(minimal_ball(std::vector{Vec3d{1, 2, 3}}), {1, 2, 3}, 0.0);
  expect_ball(minimal_ball(std::vector{Vec3d{1, 2, 3}, Vec3d{1, 2, 3}}), {1, 2, 3}, 0.0);
  expect_ball(minimal_ball(std::vector{Vec3d{0, 0, 0}, Vec3d{0, 2, 0}}), {0, 1, 0}, 1.0);
  // Right and obtuse triangles touch with their longest side only.
  expect_ball(minimal_ball(std::vector{Vec3d{0, 0, 0}, Vec3d{2, 0, 0}, Vec3d{0.5, 0.25, 0}}),
              {1, 0, 0}, 1.0);
  expect_ball(minimal_ball(std::vector{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}),
              Vec3d::all(1.0 / 3), std::sqrt(2.0 / 3));
  const std::vector<Vec3d> tetrahedron{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  expect_ball(minimal_ball(tetrahedron), {0, 0, 0}, std::sqrt(3.0));
}

TEST(MinimalBall, OfCosphericalPointsIsTheirSphere) {
  std::vector<Vec3d> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? 3.0 : -1.0, i & 2 ? 2.0 : 0.0, i & 4 ? 5.0 : 1.0});
  expect_ball(minimal_ball(corners), {1, 1, 3}, 3.0);
}

TEST(MinimalBall, OfBalls) {
  const std::vector<Ball> two{{{-1, 0, 0}, 0.5}, {{2, 0, 0}, 1.0}};
  expect_ball(minimal_ball({}, two), {0.75, 0, 0}, 2.25);
  const std::vector<Ball> nested{{{0, 0, 0}, 2.0}, {{0.5, 0, 0}, 1.0}};
  expect_ball(minimal_ball({}, nested), {0, 0, 0}, 2.0);
  expect_ball(minimal_ball(std::vector{Vec3d{4, 0, 0}}, nested), {1, 0, 0}, 3.0);
}

TEST(MinimalBall, IsNeverLargerThanRittersWhichEncloses) {
  Rng rng(1);
  double worst = 1.0;
  for (int round = 0; round < 200; ++round) {
    std::vector<Vec3d> points;
    std::vector<Ball> balls;
    const auto point = [&] {
      const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1);
      return Vec3d{x, y, rng.uniform(-1, 1)};
    };
    for (int i = 0; i <= round % 50; ++i) points.push_back(point());
    for (int i = 0; i < round % 4; ++i) balls.push_back({point(), rng.uniform()});
    const Ball least = minimal_ball(points, balls), quick = ritter_ball(points, balls);
    EXPECT_LE(least.radius, quick.radius);
    if (least.radius > 0.0) worst = std::max(worst, quick.radius / least.radius);
    for (const Ball& ball : {least, quick}) {
      for (const Vec3d& p : points) EXPECT_LE(length(p - ball.center), ball.radius * (1 + 1e-15));
      for (const Ball& b : balls)
        EXPECT_LE(length(b.center - ball.center) + b.radius, ball.radius * (1 + 1e-15));
    }
  }
  EXPECT_LT(worst, 1.25);
}

}  // namespace
}  // namespace strahl
