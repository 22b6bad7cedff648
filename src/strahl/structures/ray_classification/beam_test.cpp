// Beams never lose what a ray of their cell meets, and do sort out most of what none meets.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/structures/ray_classification/beam.h>

namespace strahl {
namespace {

/// A cell with a ray in it.
struct CellWithRay {
  RayCell cell;
  int face;
  Vec3d org, dir;
};

class BeamTest : public testing::Test {
 protected:
  double any() { return rng_.uniform(-1, 1); }
  Vec3d any_point() {
    const double x = any(), y = any();
    return {x, y, any()};
  }
  /// In [lo, hi], often at an end.
  double within(double lo, double hi) {
    const std::uint32_t choice = rng_.below(6);
    return choice == 0 ? lo : choice == 1 ? hi : std::clamp(rng_.uniform(lo, hi), lo, hi);
  }
  CellWithRay any_cell() {
    CellWithRay c{{{-1, -1, -1, -1, -1}, {1, 1, 1, 1, 1}}, static_cast<int>(rng_.below(6)), {}, {}};
    for (std::uint32_t depth = rng_.below(6); depth > 0; --depth)
      c.cell = c.cell.child(rng_.below(RayCell::kChildren));
    c.org = {within(c.cell.lo[0], c.cell.hi[0]), within(c.cell.lo[1], c.cell.hi[1]),
             within(c.cell.lo[2], c.cell.hi[2])};
    const int axis = c.face / 2;
    c.dir[axis] = c.face % 2 == 0 ? 1.0 : -1.0;
    c.dir[(axis + 1) % 3] = within(c.cell.lo[3], c.cell.hi[3]);
    c.dir[(axis + 2) % 3] = within(c.cell.lo[4], c.cell.hi[4]);
    return c;
  }
  /// On the ray, often near its origin, never behind it; off by up to `slack`.
  Vec3d on_ray(const CellWithRay& c, double slack) {
    const double s = rng_.below(4) == 0 ? 0.0 : std::ldexp(2.0, -static_cast<int>(rng_.below(12)));
    return c.org + s * c.dir + slack * any_point();
  }
  /// A triangle that holds the point: inside, on an edge, at a corner; of any size, often a sliver.
  std::vector<StoredBall> triangle_around(const Vec3d& p) {
    const double size = std::ldexp(1.0, -static_cast<int>(rng_.below(14)));
    const Vec3d along = size * any_point();
    const Vec3d across = (rng_.below(3) == 0 ? 1e-5 : 1.0) * size * any_point();
    const Vec3d a = p - within(0, 1) * along - within(0, 1) * across;
    const double s = within(0, 1), r = within(0, 1 - s);
    const Vec3d corner = p - s * along - r * across;
    const bool is_inside = rng_.below(2) == 0;
    const Vec3d from = is_inside ? corner : a;
    return is_inside ? stored({from, from + along, from + across})
                     : stored({p, p + along, p + across});
  }
  static std::vector<StoredBall> stored(const std::vector<Vec3d>& points, double radius = 0.0) {
    std::vector<StoredBall> balls;
    for (const Vec3d& p : points)
      balls.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z),
                       static_cast<float>(radius)});
    return balls;
  }

  Rng rng_{1};
};

// Beyond the slack that the float corners need, so that the proof's sum is what is tried.
constexpr double kOff = kRaySlack;

TEST_F(BeamTest, NoTriangleThatARayMeetsIsOut) {
  for (int i = 0; i < 80000; ++i) {
    const CellWithRay c = any_cell();
    const auto triangle = triangle_around(on_ray(c, kOff));
    ASSERT_TRUE(Beam(c.cell, c.face).may_meet_triangle(triangle)) << i;
  }
}

TEST_F(BeamTest, NoHullOrBoxThatARayMeetsIsOut) {
  for (int i = 0; i < 50000; ++i) {
    const CellWithRay c = any_cell();
    const Beam beam(c.cell, c.face);
    const Vec3d p = on_ray(c, kOff);
    const double radius = std::ldexp(1.0, -static_cast<int>(rng_.below(20)));
    const Vec3d out = any_point(), center = p + radius / length(out) * out;
    ASSERT_TRUE(beam.may_meet_hull(stored({center}, radius))) << i;
    const Vec3d end = p + 0.5 * any_point();
    const auto capsule = stored({center, end, end}, radius);
    ASSERT_TRUE(beam.may_meet_hull(std::span(capsule).first(2))) << i;
    const Vec3d half = radius * abs(any_point());
    Vec3d lo = p - half, hi = p + half;
    const int side = static_cast<int>(rng_.below(3));
    (rng_.below(2) == 0 ? lo : hi)[side] = p[side];
    ASSERT_TRUE(beam.may_meet(lo, hi)) << i;
  }
}

TEST_F(BeamTest, NoTriangleSeenFromTheFrontIsABackForAll) {
  int fronts = 0, backs = 0;
  for (int i = 0; i < 50000; ++i) {
    const CellWithRay c = any_cell();
    const auto triangle = triangle_around(on_ray(c, 0.0));
    const Vec3d a = triangle[0].center();
    const Vec3d n = cross(triangle[1].center() - a, triangle[2].center() - a);
    const bool may = Beam(c.cell, c.face).may_see_front(triangle);
    if (dot(n, c.dir) <= 0.0)
      ASSERT_TRUE(may) << i;
    else
      ++fronts, backs += !may;
  }
  EXPECT_GT(backs, fronts / 4) << "nothing is culled";
}

/// Whether one of many rays of the cell meets the triangle.
bool is_met(const RayCell& cell, int face, std::span<const StoredBall> t, Rng& rng) {
  const Vec3d a = t[0].center(), b = t[1].center(), c = t[2].center();
  for (int i = 0; i < 400; ++i) {
    double at[5];
    for (std::size_t k = 0; k < 5; ++k) at[k] = rng.uniform(cell.lo[k], cell.hi[k]);
    const Vec3d o{at[0], at[1], at[2]};
    Vec3d w;
    w[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
    w[(face / 2 + 1) % 3] = at[3], w[(face / 2 + 2) % 3] = at[4];
    const double e1 = dot(w, cross(a - o, b - o)), e2 = dot(w, cross(b - o, c - o));
    const double e3 = dot(w, cross(c - o, a - o));
    const Vec3d n = cross(b - a, c - a);
    if ((e1 > 0) == (e2 > 0) && (e2 > 0) == (e3 > 0) && dot(a - o, n) / dot(w, n) >= 0) return true;
  }
  return false;
}

TEST_F(BeamTest, MostOfWhatNoRayMeetsIsOut) {
  int out = 0, only_sides = 0, unmet = 0;
  for (int i = 0; i < 1500; ++i) {
    CellWithRay c = any_cell();
    while (c.cell.hi[0] - c.cell.lo[0] > 0.3) c.cell = c.cell.child(rng_.below(32));
    std::vector<Vec3d> corners(3, any_point());
    const double size = rng_.uniform(0.05, 1.0);
    for (Vec3d& corner : corners) corner = corner + size * any_point();
    const auto triangle = stored(corners);
    if (is_met(c.cell, c.face, triangle, rng_)) continue;
    const Beam beam(c.cell, c.face);
    ++unmet;
    out += !beam.may_meet_triangle(triangle);
    only_sides += !beam.may_meet_hull(triangle);
  }
  EXPECT_GT(out, unmet * 97 / 100) << unmet;
  EXPECT_GT(out, only_sides);
  RecordProperty("unmet", unmet), RecordProperty("out", out);
  RecordProperty("only_sides", only_sides);
}

}  // namespace
}  // namespace strahl
