#include <numbers>

#include <strahl/bounds/volume_cases_test.h>

namespace strahl {
namespace {

using namespace test;

constexpr FitEffort kEfforts[] = {FitEffort::fast, FitEffort::thorough};

template <class V>
class VolumeTest : public ::testing::Test {};
TYPED_TEST_SUITE(VolumeTest, AllVolumes, VolumeNames);

TYPED_TEST(VolumeTest, OfNothingContainsNothing) {
  const TypeParam none, also_none = TypeParam::enclose({}, FitEffort::thorough);
  for (const TypeParam& v : {none, also_none, TypeParam::merge(none, none)}) {
    EXPECT_FALSE(v.contains({0, 0, 0}));
    EXPECT_EQ(v.half_area(), 0.0);
    EXPECT_EQ(v.volume(), 0.0);
    const Aabb world{{-1, -1, -1}, {1, 1, 1}};
    for (const Vec3d& dir : {Vec3d{1, 0, 0}, Vec3d{-1, 2, 0.5}})
      EXPECT_FALSE(keeps(passage(v, prepared({0, 0, 0}, dir, world), world), 0.0));
    EnclosedSet corners;
    v.add_corners_to(corners);
    EXPECT_TRUE(corners.is_empty());
  }
}

TYPED_TEST(VolumeTest, ContainsItsPointsAndWhatLiesBetween) {
  std::vector<PointSet> sets = grid_sets();
  for (PointSet& set : wild_sets()) sets.push_back(std::move(set));
  Rng rng(3);
  for (const PointSet& set : sets) {
    for (const FitEffort effort : kEfforts) {
      const TypeParam v = TypeParam::enclose(set.enclosed(), effort);
      for (const Vec3d& p : set.points) EXPECT_TRUE(v.contains(p)) << set.name;
      for (std::size_t i = 0; i + 2 < set.points.size();
           i += 3)  // of the triangles: shells have holes
        EXPECT_TRUE(v.contains(mixture({set.points[i], set.points[i + 1], set.points[i + 2]}, rng)))
            << set.name;
      EXPECT_GE(v.bytes(), sizeof(v));
    }
  }
}

TYPED_TEST(VolumeTest, MergesIntoOneAroundBoth) {
  Rng rng(19);
  std::vector<PointSet> sets = grid_sets();
  for (PointSet& set : wild_sets()) sets.push_back(std::move(set));
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const PointSet &one = sets[i], &two = sets[(i * 5 + 3) % sets.size()];
    const TypeParam a = TypeParam::enclose(one.enclosed(), FitEffort::fast),
                    b = TypeParam::enclose(two.enclosed(), FitEffort::fast);
    const TypeParam both = TypeParam::merge(a, b);
    for (const PointSet* set : {&one, &two})
      for (const Vec3d& p : set->points)
        EXPECT_TRUE(both.contains(p)) << one.name << " + " << two.name;
    // And not only the points: what lies in the volumes themselves.
    EnclosedSet corners;
    a.add_corners_to(corners);
    if (corners.is_unbounded() || corners.is_empty()) continue;
    const Aabb box = corners.box();
    for (int k = 0; k < 200; ++k) {
      const Vec3d p = box.lo + Vec3d{rng.uniform() * box.extent().x, rng.uniform() * box.extent().y,
                                     rng.uniform() * box.extent().z};
      if (a.contains(p)) {
        EXPECT_TRUE(both.contains(p)) << one.name << " + " << two.name;
      }
    }
    EXPECT_TRUE(TypeParam::merge(a, TypeParam()).contains(one.points[0]));
    EXPECT_TRUE(TypeParam::merge(TypeParam(), a).contains(one.points[0]));
  }
}

TYPED_TEST(VolumeTest, OfMeasuresAgreesWithRandomPointsAndLines) {
  Rng rng(23);
  for (const std::size_t which : {6u, 10u, 11u, 12u}) {
    const PointSet set = grid_sets()[which];
    const EnclosedSet enclosed = set.enclosed();
    const TypeParam v = TypeParam::enclose(enclosed, FitEffort::fast);
    const Ball ball = [&] {
      EnclosedSet corners;
      v.add_corners_to(corners);
      return SphereVolume::enclose(corners, FitEffort::fast).ball();
    }();
    const Aabb world{ball.center - Vec3d::all(ball.radius), ball.center + Vec3d::all(ball.radius)};
    constexpr int kSamples = 20000;
    int inside = 0, met = 0;
    for (int i = 0; i < kSamples; ++i) {
      const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1), z = rng.uniform(-1, 1);
      inside += v.contains(ball.center + ball.radius * Vec3d{x, y, z});
      // A uniform line through the ball: direction on the sphere, point in the disc across it.
      const double height = rng.uniform(-1, 1), turn = rng.uniform(0, 2 * std::numbers::pi);
      const double flat = std::sqrt(1 - height * height);
      const Basis basis({flat * std::cos(turn), flat * std::sin(turn), height});
      const double r = ball.radius * std::sqrt(rng.uniform()),
                   phi = rng.uniform(0, 2 * std::numbers::pi);
      const Vec3d org = ball.center + (r * std::cos(phi)) * basis.u +
                        (r * std::sin(phi)) * basis.v - (2.0 * ball.radius) * basis.w;
      const Interval span = passage(v, prepared(org, basis.w, world), world);
      met += span.t_enter <= span.t_exit;
    }
    const auto agrees = [&](int count, double expected) {
      const double share = static_cast<double>(count) / kSamples;
      const double sigma = std::sqrt(expected * (1 - expected) / kSamples);
      return std::abs(share - expected) <= 4 * sigma + 1e-4;
    };
    const double cube = 8.0 * ball.radius * ball.radius * ball.radius;
    EXPECT_TRUE(agrees(inside, v.volume() / cube))
        << set.name << ' ' << v.volume() << ' ' << inside;
    const double chance = v.half_area() / (2 * std::numbers::pi * ball.radius * ball.radius);
    if (TypeParam::kKind == BoundingVolumeKind::shell) {
      // The hole lets lines through, so the hull is met more often.
      EXPECT_LE(static_cast<double>(met) / kSamples, chance + 0.015) << set.name;
    } else {
      EXPECT_NEAR(static_cast<double>(met) / kSamples, chance, 0.015) << set.name;
    }
  }
}

TEST(BoundingVolumeList, NamesEveryKindOnce) {
  for (std::size_t i = 0; i < kBoundingVolumes.size(); ++i) {
    const BoundingVolumeInfo& info = kBoundingVolumes[i];
    EXPECT_EQ(static_cast<std::size_t>(info.kind), i);
    EXPECT_EQ(with_volume_type(info.kind, []<class V>() { return V::kKind; }), info.kind);
    EXPECT_EQ(info_of(info.kind).name, info.name);
  }
}

}  // namespace
}  // namespace strahl
