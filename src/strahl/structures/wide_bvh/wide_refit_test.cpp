// Wide trees that follow their things: what stays, when they are built anew, what failures leave.
#include <cmath>
#include <tests/support/box_source.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/base/rng.h>
#include <strahl/structures/wide_bvh/wide_bvh.h>

namespace strahl {
namespace {

/// Triangles strewn over a cube, each moved by up to `reach`, or stretched away from the middle.
Scene strewn(std::size_t count, double reach, double stretch = 1.0, double far = 0.0) {
  Rng rng(1), shake(2);
  std::vector<Vec3f> vertices;
  std::vector<std::uint32_t> indices;
  const auto vector = [](Rng& from, double most) {
    const double x = from.uniform(-most, most), y = from.uniform(-most, most);
    return Vec3d{x, y, from.uniform(-most, most)};
  };
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d middle = vector(rng, 1.0), by = vector(shake, reach);
    for (int k = 0; k < 3; ++k) {
      indices.push_back(static_cast<std::uint32_t>(vertices.size()));
      const Vec3d corner = middle + vector(rng, 0.05);
      vertices.push_back(Vec3f(stretch * (corner + by) + Vec3d{far, 0, 0}));
    }
  }
  SceneData data;
  data.geometries.emplace_back().mesh = make_mesh(std::move(vertices), std::move(indices));
  return Scene(std::move(data));
}

std::uint64_t hash_of(const WideBvh& bvh) {
  Hash64 hash;
  bvh.hash_into(hash);
  return hash.digest();
}

WideBvhOptions lasting(WideQuality quality = WideQuality::balanced) {
  WideBvhOptions options;
  options.quality = quality, options.rebuild_factor = 1000.0;
  return options;
}

TEST(WideRefit, KeepsTheNodesAndMakesThemFitAnew) {
  const Scene before = strewn(2000, 0.0), after = strewn(2000, 0.1);
  for (const WideQuality quality : {WideQuality::fast, WideQuality::balanced, WideQuality::high})
    for (const WideWidth width : {WideWidth::eight, WideWidth::sixteen}) {
      WideBvhOptions options = lasting(quality);
      options.width = width;
      WideBvh bvh(before, options, {});
      const std::uint64_t fresh = hash_of(bvh), nodes = bvh.report().nodes;
      const bool is_cut = quality == WideQuality::high || bvh.report().references > before.size();
      ASSERT_FALSE(is_cut && quality == WideQuality::fast);
      bvh.refit(after, {});
      EXPECT_EQ(bvh.refits(), 1u);
      EXPECT_EQ(bvh.report().nodes, nodes);
      EXPECT_NO_THROW(bvh.validate(after));
      EXPECT_THROW(bvh.validate(before), std::logic_error);
      bvh.refit(before, {});
      EXPECT_NO_THROW(bvh.validate(before));
      if (is_cut) continue;  // cut primitives are whole from now on
      EXPECT_EQ(hash_of(bvh), fresh) << "back where things were";
      EXPECT_NEAR(bvh.growth(), 1.0, 1e-12);
    }
}

TEST(WideRefit, ChangesItsFrameWhereThingsMoveOrGrowFar) {
  const Scene before = strewn(500, 0.0);
  for (const Scene& after : {strewn(500, 0.1, 1.0, 1e6), strewn(500, 0.1, 1e9)}) {
    WideBvh bvh(before, lasting(), {});
    ASSERT_TRUE(bvh.tree().frame.is_identity());
    bvh.refit(after, {});
    EXPECT_EQ(bvh.refits(), 1u);
    EXPECT_FALSE(bvh.tree().frame.is_identity());
    EXPECT_NO_THROW(bvh.validate(after));
    bvh.refit(before, {});
    EXPECT_TRUE(bvh.traces_floats());
    EXPECT_NO_THROW(bvh.validate(before));
  }
}

TEST(WideRefit, BuildsAnewWhereTheCostHasGrownByTheFactor) {
  const Scene before = strewn(2000, 0.0), after = strewn(2000, 0.1);
  WideBvh kept(before, lasting(), {});
  EXPECT_EQ(kept.growth(), 1.0);
  kept.refit(after, {});
  const double growth = kept.growth();
  ASSERT_GT(growth, 1.2);
  for (const double factor : {0.99 * growth, 1.01 * growth}) {
    WideBvhOptions options;
    options.rebuild_factor = factor;
    WideBvh bvh(before, options, {});
    bvh.refit(after, {});
    const bool is_new = factor < growth;
    EXPECT_EQ(bvh.refits(), is_new ? 0u : 1u);
    EXPECT_EQ(hash_of(bvh) == hash_of(WideBvh(after, options, {})), is_new);
    EXPECT_NO_THROW(bvh.validate(after));
  }
}

TEST(WideRefit, BuildsAnewWhereThingsComeOrGo) {
  test::Boxes all;
  for (int i = 0; i < 100; ++i) all.boxes.push_back({Vec3d::all(i), Vec3d::all(i + 0.5)});
  test::Boxes less = all;
  less.boxes[7] = Aabb{};
  WideBvh bvh(all, lasting(), {});
  for (const test::Boxes* source : {&less, &all}) {
    bvh.refit(*source, {});
    EXPECT_EQ(bvh.refits(), 0u);
    EXPECT_NO_THROW(bvh.validate(*source));
  }
  bvh.refit(all, {});
  EXPECT_EQ(bvh.refits(), 1u);
}

TEST(WideRefit, LeavesEverythingWhereItFails) {
  const Scene before = strewn(2000, 0.0), after = strewn(2000, 0.1);
  WideBvh bvh(before, lasting(), {});
  const std::uint64_t fresh = hash_of(bvh);
  BuildContext cancelled, late, small;
  cancelled.progress = [](double, std::string_view) { return false; };
  late.progress = [](double fraction, std::string_view) { return fraction < 0.4; };
  small.memory_limit = 100'000;
  for (const BuildContext* context : {&cancelled, &late, &small}) {
    EXPECT_THROW(bvh.refit(after, *context), Error);
    EXPECT_EQ(hash_of(bvh), fresh);
    EXPECT_EQ(bvh.refits(), 0u);
    EXPECT_NO_THROW(bvh.validate(before));
  }
}

TEST(WideRefit, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const Scene before = strewn(20000, 0.0), after = strewn(20000, 0.1);
  BuildContext two;
  two.executor = Executor::with_threads(2);
  WideBvh a(before, lasting(), {}), b(before, lasting(), {});
  a.refit(after, {}), b.refit(after, two);
  EXPECT_EQ(hash_of(a), hash_of(b));
  EXPECT_EQ(a.growth(), b.growth());
}

}  // namespace
}  // namespace strahl
