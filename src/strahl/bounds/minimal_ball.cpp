#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <strahl/bounds/minimal_ball.h>

namespace strahl {
namespace {

constexpr double kOutside = 1.0 + 1e-15;
constexpr int kMostWitnesses = 200;

/// Up to four points that a ball must touch.
struct Support {
  std::array<Vec3d, 4> point;
  std::size_t count = 0;

  Support with(const Vec3d& p) const {
    Support more = *this;
    more.point[more.count++] = p;
    return more;
  }
};

using Row = std::array<long double, 4>;

/// Solves the n x n system whose right side is column n by elimination; false where singular.
bool solve(std::array<Row, 3>& m, std::size_t n) {
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::fabs(m[i][k]) > std::fabs(m[pivot][k])) pivot = i;
    std::swap(m[k], m[pivot]);
    if (!(std::fabs(m[k][k]) > 1e-17L)) return false;
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const long double f = m[i][k] / m[k][k];
      for (std::size_t j = k; j <= n; ++j) m[i][j] -= f * m[k][j];
    }
  }
  return true;
}

/// The smallest ball with all of the support on its surface. Its centre is p0 + sum x_i a_i with
/// a_i = p_i - p0 and 2 sum_j (a_i . a_j) x_j = a_i . a_i; radius -1 where there is none.
Ball touching_ball(const Support& support) {
  if (support.count == 0) return {{}, -1.0};
  const std::size_t n = support.count - 1;
  std::array<Vec3d, 3> a;
  for (std::size_t i = 0; i < n; ++i) a[i] = support.point[i + 1] - support.point[0];
  const auto product = [&](std::size_t i, std::size_t j) {
    const Vec3d &p = a[i], &q = a[j];
    return static_cast<long double>(p.x) * q.x + static_cast<long double>(p.y) * q.y +
           static_cast<long double>(p.z) * q.z;
  };
  std::array<Row, 3> m{};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) m[i][j] = 2.0L * product(i, j) / product(i, i);
    m[i][n] = 1.0L;
  }
  if (!solve(m, n)) return {{}, -1.0};
  Vec3d shift;
  for (std::size_t i = 0; i < n; ++i) shift = shift + static_cast<double>(m[i][n] / m[i][i]) * a[i];
  return {support.point[0] + shift, length(shift)};
}

bool is_outside(const Ball& ball, const Vec3d& p) {
  return !(length(p - ball.center) <= ball.radius * kOutside);
}

/// Welzl's recursion over witness[0..count), the support on the surface. Moves what mattered to the
/// front.
Ball enclose_witnesses(std::vector<Vec3d>& witness, std::size_t count, const Support& support) {
  Ball ball = touching_ball(support);
  if (support.count == 4) return ball;
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_outside(ball, witness[i])) continue;
    const Ball larger = enclose_witnesses(witness, i, support.with(witness[i]));
    if (!(larger.radius > ball.radius)) continue;
    ball = larger;
    std::rotate(witness.begin(), witness.begin() + static_cast<std::ptrdiff_t>(i),
                witness.begin() + static_cast<std::ptrdiff_t>(i) + 1);
  }
  return ball;
}

/// Farthest point of the input from a centre.
struct Farthest {
  Vec3d point;
  double distance = -1.0;
};
Farthest farthest(const Vec3d& center, std::span<const Vec3d> points, std::span<const Ball> balls) {
  Farthest most;
  for (const Vec3d& p : points) {
    const double d = length(p - center);
    if (d > most.distance) most = {p, d};
  }
  for (const Ball& b : balls) {
    const Vec3d away = b.center - center;
    const double d = length(away);
    if (!(d + b.radius > most.distance)) continue;
    const Vec3d direction = d > 0.0 ? away / d : Vec3d{1, 0, 0};
    most = {b.center + b.radius * direction, d + b.radius};
  }
  return most;
}

}  // namespace

Ball minimal_ball(std::span<const Vec3d> points, std::span<const Ball> balls) {
  if (points.empty() && balls.empty()) return {};
  Ball best = ritter_ball(points, balls);
  std::vector<Vec3d> witness;
  Vec3d center = best.center;
  double radius = -1.0;
  for (int round = 0; round < kMostWitnesses; ++round) {
    const Farthest far = farthest(center, points, balls);
    if (far.distance < best.radius) best = {center, far.distance};
    if (!(far.distance > radius * kOutside)) break;
    witness.insert(witness.begin(), far.point);
    const Ball ball = enclose_witnesses(witness, witness.size(), {});
    if (!(ball.radius > radius)) break;
    center = ball.center, radius = ball.radius;
  }
  return best;
}

Ball ritter_ball(std::span<const Vec3d> points, std::span<const Ball> balls) {
  if (points.empty() && balls.empty()) return {};
  const Vec3d start = points.empty() ? balls[0].center : points[0];
  const Vec3d a = farthest(start, points, balls).point;
  const Vec3d b = farthest(a, points, balls).point;
  Ball ball{0.5 * a + 0.5 * b, 0.5 * length(b - a)};
  const auto grow = [&](const Vec3d& center, double radius) {
    const Vec3d away = center - ball.center;
    const double d = length(away);
    if (d + radius <= ball.radius) return;
    const double larger = 0.5 * (d + radius + ball.radius);
    if (d > 0.0) ball.center = ball.center + ((larger - ball.radius) / d) * away;
    ball.radius = std::max(larger, radius);
  };
  for (const Vec3d& p : points) grow(p, 0.0);
  for (const Ball& s : balls) grow(s.center, s.radius);
  ball.radius = farthest(ball.center, points, balls).distance;
  return ball;
}

}  // namespace strahl
