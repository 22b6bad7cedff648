#include <cmath>
#include <limits>
#include <tests/support/curved_cases.h>

#include <gtest/gtest.h>

#include <strahl/geometry/curved.h>
#include <strahl/math/coordinate.h>
#include <strahl/math/expansion.h>

namespace strahl {
namespace {

using test::Wide;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Aabb kUnitBox{{-1, -1, -1}, {1, 1, 1}};

bool is_empty(const Interval& i) { return !(i.t_enter <= i.t_exit); }

TEST(CanonicalSlab, GivesTheParametersOfEntryAndExit) {
  const Interval slab = canonical_slab({-3, 0.25, 0}, {2, 0, 0}, kUnitBox);
  EXPECT_EQ(slab.t_enter, 1.0);
  EXPECT_EQ(slab.t_exit, 2.0);
}

TEST(CanonicalSlab, CoversTheWholeLineNotOnlyTheRay) {
  const Interval slab = canonical_slab({3, 0, 0}, {1, 0, 0}, kUnitBox);
  EXPECT_EQ(slab.t_enter, -4.0);
  EXPECT_EQ(slab.t_exit, -2.0);
}

TEST(CanonicalSlab, MissesParallelToAndOutsideOfASlab) {
  for (const double zero : {0.0, -0.0})
    for (const double y : {-1.5, std::nextafter(1.0, 2.0), 1e30})
      EXPECT_TRUE(is_empty(canonical_slab({-3, y, 0}, {1, zero, zero}, kUnitBox))) << y;
}

TEST(CanonicalSlab, KeepsARayInsideAPlaneOfTheBox) {
  for (const double zero : {0.0, -0.0})
    for (const double y : {-1.0, 1.0}) {
      const Interval slab = canonical_slab({-3, y, -y}, {1, zero, zero}, kUnitBox);
      EXPECT_EQ(slab.t_enter, 2.0);
      EXPECT_EQ(slab.t_exit, 4.0);
    }
}

TEST(CanonicalSlab, MissesTheEmptyBox) {
  EXPECT_TRUE(is_empty(canonical_slab({0, 0, 0}, {1, -1, 0}, Aabb{})));
  EXPECT_TRUE(is_empty(canonical_slab({0, 0, 0}, {0, 0, -1}, Aabb{})));
}

/// Boxes and rays that share many coordinates: origins on planes, flat boxes, zero directions.
Aabb random_box(Rng& rng) {
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = rng.below(3) == 0 ? std::floor(rng.uniform(-3, 3)) : rng.uniform(-2, 2);
    const double b = rng.below(3) == 0 ? a : a + test::random_magnitude(rng, -17, 3);
    box.lo[axis] = a, box.hi[axis] = std::max(a, b);
  }
  return box;
}

Ray random_ray(Rng& rng, const Aabb& box) {
  Vec3d target;
  for (int axis = 0; axis < 3; ++axis) target[axis] = rng.uniform(box.lo[axis], box.hi[axis]);
  const double distances[] = {0.0, 1.0, 1e3, 1e12, 1e30};
  Ray ray = test::random_ray_at(rng, target, distances[rng.below(5)]);
  for (int axis = 0; axis < 3; ++axis) {
    if (rng.below(4) == 0) ray.org[axis] = rng.below(2) == 0 ? box.lo[axis] : box.hi[axis];
    if (rng.below(6) == 0) ray.dir[axis] = rng.below(2) == 0 ? 0.0 : -0.0;
    if (rng.below(12) == 0) ray.dir[axis] = std::ldexp(rng.uniform(-1, 1), -230);
  }
  if (norm_max(ray.dir) == 0.0) ray.dir.z = 1.0;
  return ray;
}

TEST(CanonicalSlab, IsEnclosedByTheFilterOfEveryEnclosingBox) {
  Rng rng(1);
  int kept = 0;
  for (int i = 0; i < 400000; ++i) {
    const Aabb box = random_box(rng);
    const Ray ray = random_ray(rng, box);
    const Interval slab = canonical_slab(ray.org, ray.dir, box);
    if (is_empty(slab) || slab.t_exit < 0.0) continue;
    ++kept;
    const Aabb outer = test::random_enclosing_box(rng, box);
    ASSERT_TRUE(test::filter_keeps(ray, outer, slab.t_enter, slab.t_exit)) << "case " << i;
  }
  EXPECT_GT(kept, 100000);
}

CurvedHits two_hits(double t0, double t1) {
  CurvedHits hits;
  hits.hit = {CurvedHit{t0, true}, CurvedHit{t1, false}};
  hits.count = 2;
  return hits;
}

TEST(TieToBox, KeepsHitsInsideTheInterval) {
  const CurvedHits tied = tie_to_box(two_hits(2.5, 3.5), {-3, 0, 0}, {1, 0, 0}, kUnitBox);
  ASSERT_EQ(tied.count, 2);
  EXPECT_EQ(tied.hit[0].t, 2.5);
  EXPECT_TRUE(tied.hit[0].is_front);
  EXPECT_EQ(tied.hit[1].t, 3.5);
  EXPECT_FALSE(tied.hit[1].is_front);
}

TEST(TieToBox, ClampsIntoTheInterval) {
  const CurvedHits tied = tie_to_box(two_hits(1.5, 4.5), {-3, 0, 0}, {1, 0, 0}, kUnitBox);
  ASSERT_EQ(tied.count, 2);
  EXPECT_EQ(tied.hit[0].t, 2.0);
  EXPECT_EQ(tied.hit[1].t, 4.0);
}

TEST(TieToBox, DropsEverythingWhenTheLineMissesTheBox) {
  EXPECT_EQ(tie_to_box(two_hits(1, 2), {-3, 2, 0}, {1, 0, 0}, kUnitBox).count, 0);
  EXPECT_EQ(tie_to_box(two_hits(1, 2), {-3, 0, 0}, {1, 0, 0}, Aabb{}).count, 0);
}

TEST(TieToBox, DropsAPairThatClampsToTheSameParameter) {
  EXPECT_EQ(tie_to_box(two_hits(1.0, 1.5), {-3, 0, 0}, {1, 0, 0}, kUnitBox).count, 0);
  EXPECT_EQ(tie_to_box(two_hits(2.5, 2.5), {-3, 0, 0}, {1, 0, 0}, kUnitBox).count, 0);
}

TEST(TieToBox, DropsNonFiniteParametersOnly) {
  for (const double bad : {kInf, -kInf, kNan}) {
    const CurvedHits tied = tie_to_box(two_hits(bad, 3.0), {-3, 0, 0}, {1, 0, 0}, kUnitBox);
    ASSERT_EQ(tied.count, 1);
    EXPECT_EQ(tied.hit[0].t, 3.0);
    EXPECT_FALSE(tied.hit[0].is_front);
  }
}

TEST(TieToBox, TurnsMinusZeroIntoPlusZero) {
  const CurvedHits tied = tie_to_box(two_hits(-0.0, 0.5), {0, 0, 0}, {1, 0, 0}, kUnitBox);
  EXPECT_FALSE(std::signbit(tied.hit[0].t));
  const CurvedHits clamped = tie_to_box(two_hits(-0.5, 0.5), {1, 0, 0}, {-1, 0, 0}, kUnitBox);
  EXPECT_EQ(clamped.hit[0].t, 0.0);
  EXPECT_FALSE(std::signbit(clamped.hit[0].t));
}

TEST(TwoProduct, IsExact) {
  Rng rng(2);
  for (int i = 0; i < 20000; ++i) {
    const double a = rng.uniform(-1, 1) * test::random_magnitude(rng, -70, 70);
    const double b = rng.uniform(-1, 1) * test::random_magnitude(rng, -70, 70);
    const TwoTerms p = two_product(a, b);
    ASSERT_EQ(p.high, a * b);
    ASSERT_TRUE(Wide(p.high) + Wide(p.low) == Wide(a) * Wide(b)) << a << " * " << b;
  }
}

TEST(NearestPoint, IsTheOffsetAtItsParameterToTwiceDoublePrecision) {
  Rng rng(3);
  for (int i = 0; i < 5000; ++i) {
    const Vec3d reference = test::random_vector(rng, 100.0), shift = test::random_vector(rng);
    const double distance = test::random_magnitude(rng, -3, 12);
    const Ray ray = test::random_ray_at(rng, reference + test::random_vector(rng, 3.0), distance);
    const LinePoint p = nearest_point(ray.org, ray.dir, reference, shift);
    const Wide t = Wide(p.t) + Wide(p.dt);
    Wide along = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Wide truth = Wide(ray.org[axis]) - Wide(reference[axis]) + t * Wide(ray.dir[axis]);
      const Wide got = Wide(p.high[axis]) + Wide(p.low[axis]);
      const double reach = norm_max(ray.org - reference);
      ASSERT_LE(std::abs(test::narrow(truth - got)), 0x1p-100 * reach) << "case " << i;
      along += (truth - Wide(shift[axis])) * Wide(ray.dir[axis]);
    }
    const double from_foot = test::narrow(along) / length(ray.dir);
    ASSERT_LE(std::abs(from_foot), 0x1p-50 * (length(p.high - shift) + 10.0)) << "case " << i;
  }
}

TEST(Unit, HasLengthOneAtAnyScale) {
  for (const double scale : {0x1p-500, 0x1p-240, 1.0, 0x1p240, 0x1p500}) {
    const Vec3d v = unit(scale * Vec3d{3, 0, -4});
    EXPECT_NEAR(v.x, 0.6, 1e-15);
    EXPECT_NEAR(v.z, -0.8, 1e-15);
  }
}

TEST(BoxAround, IsExactWherePossibleAndElseOneUlpOutward) {
  const Aabb exact = box_around({1, 0, -2}, {1, 2, 0.5});
  EXPECT_EQ(exact, (Aabb{{0, -2, -2.5}, {2, 2, -1.5}}));
  const Aabb rounded = box_around({1e20, 1, 0}, {1, 1e-20, 0});
  EXPECT_EQ(rounded.lo.x, std::nextafter(1e20, 0.0));
  EXPECT_EQ(rounded.hi.x, std::nextafter(1e20, kInf));
  EXPECT_EQ(rounded.lo.y, std::nextafter(1.0, 0.0));
  EXPECT_EQ(rounded.hi.y, std::nextafter(1.0, 2.0));
}

TEST(IsValidCoordinate, AcceptsZeroAndTwoToTheMinus240To240) {
  for (const double good : {0.0, -0.0, 0x1p-240, -0x1p240, 1.0, -3.5})
    EXPECT_TRUE(is_coordinate(good));
  for (const double bad : {0x1p-241, -0x1.8p240, 5e-324, kInf, -kInf, kNan})
    EXPECT_FALSE(is_coordinate(bad)) << bad;
  EXPECT_FALSE(is_coordinate(Vec3d{0, 0, kNan}));
}

}  // namespace
}  // namespace strahl
