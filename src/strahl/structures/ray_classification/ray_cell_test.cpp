#include <cmath>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/structures/ray_classification/ray_cell.h>

namespace strahl {
namespace {

const Aabb kBox{{-3, 10, 1000}, {5, 11, 1000.5}};

Vec3d any(Rng& rng, double reach = 1.0) {
  const double x = rng.uniform(-reach, reach), y = rng.uniform(-reach, reach);
  return {x, y, rng.uniform(-reach, reach)};
}

std::optional<RayPoint> classify(const RaySpace& space, const Ray& ray) {
  return space.classify(PreparedRay(ray, {space.box(), 0.0, 0.0}));
}

TEST(RayCell, FacesAreDominantComponentsTiesGoToTheLowerAxis) {
  const RaySpace space(kBox);
  const auto face = [&](const Vec3d& dir) {
    return classify(space, {{1, 10.5, 1000.25}, dir})->face;
  };
  EXPECT_EQ(face({1, 0.5, -0.5}), 0);
  EXPECT_EQ(face({-1, 0.5, -0.5}), 1);
  EXPECT_EQ(face({0.5, 1, 0}), 2);
  EXPECT_EQ(face({0, 0, -1e-70}), 5);
  EXPECT_EQ(face({1, 1, 1}), 0);
  EXPECT_EQ(face({-1, 1, 1}), 1);
  EXPECT_EQ(face({0.5, -1, 1}), 3);
  EXPECT_EQ(face({1, 1 + 0x1p-52, 1}), 2);
}

TEST(RayCell, LengthOfTheDirectionDoesNotMatter) {
  const RaySpace space(kBox);
  for (const double length : {0x1p-239, 1e-30, 1.0, 1e30, 0x1p239}) {
    const auto point = classify(space, {{1, 10.5, 900}, length * Vec3d{0.25, -0.5, 1}});
    ASSERT_FALSE(point);  // passes by
    const auto hit = classify(space, {{1, 10.5, 999}, length * Vec3d{0.25, -0.25, 1}});
    ASSERT_TRUE(hit);
    EXPECT_TRUE(hit->is_certain);
    EXPECT_EQ(hit->face, 4);
    EXPECT_EQ(hit->at[3], 0.25);
    EXPECT_EQ(hit->at[4], -0.25);
    const auto moved = space.local({1.25, 10.25, 1000});
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(hit->at[a], moved[static_cast<int>(a)], 1e-11);
  }
}

TEST(RayCell, OriginsOutsideAreMovedToTheBoxAndFarOnesAreUncertain) {
  const RaySpace space(kBox);
  const Vec3d target{1, 10.5, 1000.25}, dir{1, 0.01, 0.02};
  for (const double away : {0.0, 10.0, 1e3, 1e6, 1e7}) {
    const auto point = classify(space, {target - away * dir, dir});
    ASSERT_TRUE(point) << away;
    EXPECT_TRUE(point->is_certain) << away;
    EXPECT_TRUE(space.root().contains(*point)) << away;
  }
  for (const double away : {1e9, 1e12, 1e15})
    EXPECT_FALSE(classify(space, {target - away * Vec3d{1, 0, 0}, {1, 0, 0}})->is_certain) << away;
}

TEST(RayCell, WideningOfInstancesMakesRaysUncertain) {
  const RaySpace space(kBox);
  const Ray ray{{1, 10.5, 1000.25}, {1, 0, 0}};
  EXPECT_TRUE(space.classify(PreparedRay(ray, {kBox, 1e-7, 0.0}))->is_certain);
  EXPECT_FALSE(space.classify(PreparedRay(ray, {kBox, 1e-4, 0.0}))->is_certain);
}

TEST(RayCell, TheIntervalOfTheRayBeginsAndEndsIt) {
  const RaySpace space(kBox);
  const Vec3d org{-4, 10.5, 1000.25}, dir{2, 0, 0};
  EXPECT_NEAR(classify(space, {org, dir, 2.0, 9.0})->at[0], space.local({0, 0, 0}).x, 1e-9);
  EXPECT_FALSE(classify(space, {org, dir, 0.0, 0.4}));
  EXPECT_FALSE(classify(space, {org, dir, 4.6, 9.0}));
  EXPECT_FALSE(classify(space, {org, -dir}));
}

TEST(RayCell, ChildrenTileTheirParentAndDescendingFindsTheOneWithThePoint) {
  Rng rng(1);
  const RaySpace space(kBox);
  int met = 0;
  for (int i = 0; i < 4000; ++i) {
    Ray ray{kBox.center() + any(rng, i % 2 ? 8 : 0.3), any(rng)};
    if (i % 3 == 0) ray.dir[static_cast<int>(rng.below(3))] = 0.0;
    const auto point = classify(space, ray);
    if (!point) continue;
    ++met;
    RayCell cell = space.root();
    for (int depth = 0; depth < 12; ++depth) {
      ASSERT_TRUE(cell.contains(*point));
      const RayCell parent = cell;
      const unsigned number = cell.descend(*point);
      ASSERT_EQ(cell.lo, parent.child(number).lo);
      ASSERT_EQ(cell.hi, parent.child(number).hi);
      for (unsigned other = 0; other < RayCell::kChildren; ++other) {
        const RayCell child = parent.child(other), opposite = parent.child(~other & 31);
        for (std::size_t a = 0; a < 5; ++a) {
          const bool is_upper = (other >> a & 1) != 0;
          ASSERT_EQ((is_upper ? child.hi : child.lo)[a], (is_upper ? parent.hi : parent.lo)[a]);
          ASSERT_EQ((is_upper ? child.lo : child.hi)[a], (is_upper ? opposite.hi : opposite.lo)[a]);
        }
      }
    }
  }
  EXPECT_GT(met, 100);
}

TEST(RayCell, FlatAndTinyAndHugeScenesHaveLocalUnits) {
  const Aabb boxes[] = {{{0, 0, 0}, {1, 1, 0}},
                        {{1e9, 1e9, 1e9}, {1e9, 1e9, 1e9}},
                        {{0, 0, 0}, {0, 0, 0}},
                        {{0, 0, 0}, {0x1p-240, 0, 0}},
                        {{-0x1p240, -1, -1}, {0x1p240, 1, 1}}};
  for (const Aabb& box : boxes) {
    const RaySpace space(box);
    for (const Vec3d& corner : {box.lo, box.hi})
      EXPECT_LE(norm_max(space.local(corner)), 1.0) << norm_max(corner);
    const Vec3d dir{0.3, 0.2, -1};
    const auto point = classify(space, {box.hi, dir});
    ASSERT_TRUE(point);
    EXPECT_TRUE(point->is_certain);
    EXPECT_TRUE(space.root().contains(*point));
  }
}

}  // namespace
}  // namespace strahl
