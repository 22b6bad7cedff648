// What each kind has that the others have not; what all share is volume_test and volume_rays_test.
#include <cmath>
#include <numbers>

#include <strahl/bounds/volume_cases_test.h>

namespace strahl {
namespace {

using namespace test;

constexpr double kPi = std::numbers::pi;

EnclosedSet set_of(const std::vector<Vec3d>& points) {
  EnclosedSet set;
  for (const Vec3d& p : points) set.add(p);
  return set;
}

/// A box turned by some rotation that is not of the axes.
std::vector<Vec3d> turned_box(const Vec3d& half) {
  const Affine turn = Affine::rotation(0.5, 0.1, -0.3, std::sqrt(1 - 0.35));
  std::vector<Vec3d> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(turn.vector(
        {i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z}));
  return corners;
}

TEST(SlabRay, CutsNothingByNaN) {
  const SlabRay within(0.0, 0.0, 0.0);  // runs in both planes
  for (const Interval& cut :
       {clip_to_slab(within, 0.0, 0.0, {1, 2}), clip_to_half_space(within, 0.0, {1, 2})}) {
    EXPECT_EQ(cut.t_enter, 1.0);
    EXPECT_EQ(cut.t_exit, 2.0);
  }
  const Interval beside = clip_to_slab(within, 1.0, 2.0, {1, 2});
  EXPECT_GT(beside.t_enter, beside.t_exit);
  const Interval above = clip_to_half_space(within, -1.0, {1, 2});
  EXPECT_GT(above.t_enter, above.t_exit);
}

TEST(SphereVolume, AroundASphereIsThatSphere) {
  EnclosedSet set;
  set.add(Sphere{{1, 2, 3}, 0.5});
  for (const FitEffort effort : {FitEffort::fast, FitEffort::thorough}) {
    const Ball ball = SphereVolume::enclose(set, effort).ball();
    EXPECT_EQ(ball.center, (Vec3d{1, 2, 3}));
    EXPECT_NEAR(ball.radius, 0.5, 1e-7);
    EXPECT_GE(ball.radius, 0.5);
  }
}

TEST(SphereVolume, MergesIntoTheSmallestAroundBoth) {
  EnclosedSet a, b, inner;
  a.add(Sphere{{0, 0, 0}, 1.0}), b.add(Sphere{{4, 0, 0}, 2.0}),
      inner.add(Sphere{{0.25, 0, 0}, 0.5});
  const auto of = [](const EnclosedSet& set) { return SphereVolume::enclose(set); };
  const Ball both = SphereVolume::merge(of(a), of(b)).ball();
  EXPECT_NEAR(both.radius, 3.5, 1e-6);
  EXPECT_NEAR(both.center.x, 2.5, 1e-6);
  EXPECT_EQ(SphereVolume::merge(of(a), of(inner)).ball().radius, of(a).ball().radius);
  EXPECT_EQ(SphereVolume::merge(of(inner), of(a)).ball().radius, of(a).ball().radius);
}

TEST(ObbVolume, FindsATurnedBox) {
  const EnclosedSet set = set_of(turned_box({3, 2, 1}));
  for (const FitEffort effort : {FitEffort::fast, FitEffort::thorough}) {
    EXPECT_NEAR(ObbVolume::enclose(set, effort).volume(), 48.0, 1e-4);
    EXPECT_NEAR(ObbVolume::enclose(set, effort).half_area(), 44.0, 1e-4);
  }
  EXPECT_NEAR(ObbVolume::enclose_by_covariance(set).volume(), 48.0, 1e-3);
  EXPECT_NEAR(IntersectionVolume::enclose(set).volume(), 48.0, 1e-4);
  EXPECT_GT(AabbVolume::enclose(set).volume(), 60.0);
}

TEST(KdopVolume, OfAnOctahedron) {
  const EnclosedSet set =
      set_of({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
  EXPECT_NEAR(KdopVolume<6>::enclose(set).volume(), 8.0, 1e-6);
  EXPECT_NEAR(KdopVolume<14>::enclose(set).volume(), 4.0 / 3, 1e-5);
  EXPECT_NEAR(KdopVolume<14>::enclose(set).half_area(), 2 * std::sqrt(3.0), 1e-5);
  EXPECT_NEAR(KdopVolume<18>::enclose(set).volume(), 2.0, 1e-5);  // rhombic dodecahedron
  EXPECT_NEAR(KdopVolume<26>::enclose(set).volume(), 4.0 / 3, 1e-5);
}

TEST(KdopVolume, MergesExactly) {
  const std::vector<PointSet> sets = grid_sets();
  for (std::size_t i = 0; i + 1 < sets.size(); ++i) {
    const EnclosedSet a = sets[i].enclosed(), b = sets[i + 1].enclosed();
    EnclosedSet both = a;
    both.append(b);
    const auto merged =
        KdopVolume<26>::merge(KdopVolume<26>::enclose(a), KdopVolume<26>::enclose(b));
    const auto whole = KdopVolume<26>::enclose(both);
    EXPECT_NEAR(merged.volume(), whole.volume(), 1e-5 * (1 + whole.volume()));
    EXPECT_EQ(merged.box(), whole.box());
  }
}

TEST(CylinderVolume, FindsARod) {
  EnclosedSet set;
  const Vec3d axis = unit({1, 2, -0.5});
  set.add(Cone{{0, 0, 0}, 0.1, 5.0 * axis, 0.1});
  for (const FitEffort effort : {FitEffort::fast, FitEffort::thorough}) {
    const CylinderVolume v = CylinderVolume::enclose(set, effort);
    EXPECT_GE(v.volume(), kPi * 0.05);
    EXPECT_LE(v.volume(), kPi * 0.05 * 1.03);  // the rims are polygons 0.9 % wider
    EXPECT_NEAR(v.half_area(), kPi * 0.1 * (0.1 + 5.0), 0.03);
    EXPECT_LT(v.half_area(), 0.5 * SphereVolume::enclose(set).half_area());
  }
}

TEST(CylinderVolume, LetsParallelRaysPassInsideOnly) {
  EnclosedSet set;
  set.add(Cone{{0, 0, 0}, 1.0, {0, 0, 5}, 1.0});
  const CylinderVolume v = CylinderVolume::enclose(set);
  const Aabb world = set.box();
  const Interval inside = passage(v, prepared({0.5, 0.5, -3}, {0, 0, 2}, world), world);
  EXPECT_NEAR(inside.t_enter, 1.5, 1e-5);
  EXPECT_NEAR(inside.t_exit, 4.0, 1e-5);
  const Interval outside = passage(v, prepared({0.8, 0.8, -3}, {0, 0, 2}, world), world);
  EXPECT_GT(outside.t_enter, outside.t_exit);
}

TEST(HullVolume, IsTheHullWhileThePlanesLast) {
  const EnclosedSet box = set_of(turned_box({3, 2, 1}));
  EXPECT_NEAR(HullVolume::enclose(box).volume(), 48.0, 1e-3);
  const PointSet triangle = grid_sets()[6];
  const TriangleVertices t{triangle.points[0], triangle.points[1], triangle.points[2]};
  const HullVolume flat = HullVolume::enclose(triangle.enclosed());
  EXPECT_NEAR(flat.half_area(), 0.5 * length(cross(t.b - t.a, t.c - t.a)), 1e-4);
  EXPECT_NEAR(flat.volume(), 0.0, 1e-6);
  const PointSet sphere = wild_sets()[12];
  ASSERT_EQ(sphere.name, "on a sphere");
  const HullVolume round = HullVolume::enclose(sphere.enclosed());
  EXPECT_EQ(round.bytes(), sizeof(HullVolume) + HullVolume::kMostPlanes * sizeof(FacePlane));
  EXPECT_LT(round.volume(), 1.2 * 4.0 / 3 * kPi);
  EXPECT_LT(HullVolume::enclose(sphere.enclosed(), FitEffort::fast).bytes(), round.bytes());
}

TEST(PrismVolume, FindsATurnedPrism) {
  const Affine turn = Affine::rotation(0.5, 0.1, -0.3, std::sqrt(1 - 0.35));
  std::vector<Vec3d> corners;
  for (int i = 0; i < 5; ++i)
    for (const double z : {-4.0, 4.0})
      corners.push_back(turn.vector({std::cos(0.4 * kPi * i), std::sin(0.4 * kPi * i), z}));
  const double base = 2.5 * std::sin(0.4 * kPi);
  EXPECT_NEAR(PrismVolume::enclose(set_of(corners)).volume(), 8 * base, 0.02);
}

TEST(PrismVolume, ReducesPolygonsOutward) {
  std::vector<Vec2d> circle;
  for (int i = 0; i < 100; ++i)
    circle.push_back({std::cos(0.02 * kPi * i), std::sin(0.02 * kPi * i)});
  EXPECT_EQ(reduced_normals(circle, 8).size(), 6u);
  EXPECT_EQ(reduced_normals({{0, 0}, {1, 0}, {0, 1}}, 8).size(), 3u);
  EXPECT_EQ(reduced_normals({{0, 0}}, 8).size(), 4u);
  EXPECT_EQ(reduced_normals({{0, 0}, {1, 0}}, 8).size(), 4u);
  EXPECT_EQ(reduced_normals({{0, 0}, {1, 0}, {0.5, 1e-6}}, 8).size(), 5u);  // two sharp corners
  // A sliver stays bounded although its long sides are parallel in float.
  const EnclosedSet sliver = set_of({{0, 0, 0}, {1, 1, 0}, {0.5, 0.5 + 1e-9, 0}});
  EXPECT_LT(PrismVolume::enclose(sliver).half_area(), 0.01);
}

TEST(ShellVolume, IsThinAroundACurvedSheet) {
  // A dish: part of a sphere of radius 10, ten degrees around its pole.
  EnclosedSet dish;
  const auto at = [](double polar, double turn) {
    return 10.0 * Vec3d{std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                        std::cos(polar)};
  };
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 40; ++j) {
      const double p = 0.0175 * i, q = p + 0.0175, a = 0.05 * kPi * j, b = a + 0.05 * kPi;
      dish.add(TriangleVertices{at(p, a), at(q, a), at(q, b)});
      dish.add(TriangleVertices{at(p, a), at(q, b), at(p, b)});
    }
  const ShellVolume shell = ShellVolume::enclose(dish);
  EXPECT_LT(shell.volume(), 0.2 * AabbVolume::enclose(dish).volume());
  EXPECT_FALSE(shell.contains({0, 0, 9.9}));
  EXPECT_TRUE(shell.contains({0, 0, 10.0}));
  // A ray below the dish goes through the hole of the shell and misses the box of it, too; one
  // along the axis enters where the sheet is.
  const Aabb world = dish.box();
  const Interval up = passage(shell, prepared({0, 0, 5}, {0, 0, 1}, world), world);
  EXPECT_NEAR(up.t_enter, 5.0, 0.01);
  EXPECT_NEAR(up.t_exit, 5.0, 0.01);
  const Interval under = passage(shell, prepared({-9, 0, 9.9}, {1, 0, 0}, world), world);
  EXPECT_TRUE(under.t_enter > under.t_exit || under.t_exit - under.t_enter < 3.0);
}

TEST(ShellVolume, OfASphereHasItsHole) {
  EnclosedSet set;
  set.add(Sphere{{0, 0, 0}, 2.0});
  const ShellVolume shell = ShellVolume::enclose(set);
  EXPECT_FALSE(shell.contains({0, 0, 1.9}));
  EXPECT_NEAR(shell.half_area(), 8 * kPi, 1e-4);
  const Aabb world = set.box();
  // From inside the hole the ray enters at the surface.
  const Interval out = passage(shell, prepared({0.5, 0, 0}, {1, 0, 0}, world), world);
  EXPECT_NEAR(out.t_enter, 1.5, 1e-5);
  EXPECT_NEAR(out.t_exit, 1.5, 1e-5);
  PreparedRay within = prepared({0.5, 0, 0}, {1, 0, 0}, world);
  within.t_exit = 1.0;
  const Interval none = passage(shell, within, world);
  EXPECT_GT(none.t_enter, none.t_exit);
  const ShellVolume twice = ShellVolume::merge(shell, shell);
  EXPECT_FALSE(twice.contains({0, 0, 1.9}));
}

TEST(ShellVolume, FitsTheCentreOfASphere) {
  Rng rng(1);
  std::vector<Vec3d> points;
  for (int i = 0; i < 50; ++i) points.push_back(Vec3d{1, 2, 3} + 4.0 * unit(grid_point(rng)));
  EXPECT_LT(length(fitted_center(points) - Vec3d{1, 2, 3}), 1e-12);
  for (Vec3d& p : points) p.z = 0.0;
  EXPECT_TRUE(std::isnan(fitted_center(points).x));
}

TEST(Intersection, OfOtherKindsIsBoundedByTheLeast) {
  using Round = Intersection<SphereVolume, CylinderVolume, AabbVolume>;
  static_assert(BoundingVolume<Round>);
  const PointSet set = grid_sets()[11];
  const EnclosedSet enclosed = set.enclosed();
  const Round v = Round::enclose(enclosed);
  const double least = std::min({SphereVolume::enclose(enclosed).half_area(),
                                 CylinderVolume::enclose(enclosed).half_area(),
                                 AabbVolume::enclose(enclosed).half_area()});
  EXPECT_EQ(v.half_area(), least);
  for (const Vec3d& p : set.points) EXPECT_TRUE(v.contains(p));
  const Aabb world = enclosed.box();
  const Interval span = passage(v, prepared({-4, 0, 0}, {1, 0.01, 0}, world), world);
  EXPECT_FALSE(span.t_enter > span.t_exit);
  const Interval miss = passage(v, prepared({-4, 3, 0}, {1, 0.01, 0}, world), world);
  EXPECT_GT(miss.t_enter, miss.t_exit);
}

TEST(Volumes, BeyondFloatAreMetByEveryRay) {
  PointSet huge = wild_sets()[6];
  ASSERT_EQ(huge.name, "size 2^200");
  const EnclosedSet set = huge.enclosed();
  const Aabb world = set.box();
  for (const BoundingVolumeInfo& info : kBoundingVolumes) {
    with_volume_type(info.kind, [&]<class V>() {
      const V v = V::enclose(set, FitEffort::fast);
      const PreparedRay ray = prepared(Vec3d::all(0x1p199), {1, 0.5, 0.25}, world);
      EXPECT_TRUE(keeps(passage(v, ray, world), 1.0)) << info.name;
      EXPECT_TRUE(V::merge(v, v).contains(set.points()[0])) << info.name;
    });
  }
}

}  // namespace
}  // namespace strahl
