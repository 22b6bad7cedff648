#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/geometry/scene.h>
#include <strahl/structures/wide_bvh/wide_layout.h>
#include <strahl/structures/wide_bvh/wide_refs.h>

namespace strahl {
namespace {

/// Triangles of doubles around `at`, every third one without area.
Scene scene_at(const Vec3d& at, double size, std::size_t count) {
  Rng rng(1);
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < 3 * count; ++i) {
    const double x = rng.uniform(-size, size), y = rng.uniform(-size, size);
    vertices.push_back(at + Vec3d{x, y, rng.uniform(-size, size)});
    indices.push_back(i / 3 % 3 == 2 ? i / 3 * 3 : i);
  }
  SceneData data;
  data.geometries.emplace_back().mesh = make_mesh(std::move(vertices), std::move(indices));
  return Scene(std::move(data));
}

TEST(WideRefs, EnclosesWhatCanBeHitInAnyFrame) {
  struct Place {
    double far, size;
  };
  for (const auto& [far, size] :
       {Place{0, 1e-30}, Place{0, 1}, Place{0, 1e20}, Place{1e3, 1e-3}, Place{1e9, 1}}) {
    const Scene scene = scene_at({far, -far, 0}, size, 1000);
    WideRefs made = make_wide_refs(scene, {});
    EXPECT_EQ(made.frame.is_identity(), far == 0.0 && size == 1.0);
    EXPECT_GT(made.count, 600u);
    EXPECT_FALSE(made.all_floats);
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < scene.size(); ++i) {
      const Aabb box = scene.bounds(i);
      if (box.is_empty()) continue;
      ASSERT_LT(next, made.count);
      const FloatRef& ref = made.refs()[next++];
      ASSERT_EQ(ref.reference, i);
      ASSERT_EQ(ref.weight, 1u);
      const Aabb held = ref.box().box();
      for (int a = 0; a < 3; ++a) {
        using Wide = long double;
        const Wide lo = (Wide{box.lo[a]} - made.frame.center[a]) * made.frame.scale;
        const Wide hi = (Wide{box.hi[a]} - made.frame.center[a]) * made.frame.scale;
        ASSERT_LE(Wide{held.lo[a]}, lo);
        ASSERT_GE(Wide{held.hi[a]}, hi);
        ASSERT_LE(hi - Wide{held.hi[a]}, 0.0L);
        ASSERT_LE(Wide{held.hi[a]} - hi, 1e-6L * made.frame.reach);
      }
    }
    EXPECT_EQ(next, made.count);
  }
}

TEST(WideRefs, ClosesGapsTheSameWayForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const Scene scene = scene_at({5, 0, 0}, 1.0, 30'000);
  BuildContext two;
  two.executor = Executor::with_threads(2);
  WideRefs serial = make_wide_refs(scene, {}), parallel = make_wide_refs(scene, two);
  ASSERT_EQ(serial.count, 20'000u);
  ASSERT_EQ(parallel.count, serial.count);
  for (std::size_t i = 0; i < serial.count; ++i) {
    ASSERT_EQ(serial.refs()[i].reference, i / 2 * 3 + i % 2);
    ASSERT_EQ(std::memcmp(&serial.refs()[i], &parallel.refs()[i], sizeof(FloatRef)), 0);
  }
}

TEST(WideRefs, KnowsDoublesThatAreFloats) {
  std::vector<Vec3d> vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1 / 3.0}};
  for (const bool has_other : {false, true}) {
    SceneData data;
    data.geometries.emplace_back().mesh =
        make_mesh(std::vector<Vec3d>(vertices), {0u, 1u, has_other ? 3u : 2u});
    EXPECT_EQ(make_wide_refs(Scene(std::move(data)), {}).all_floats, !has_other);
  }
}

/// The rule itself: the pair of child and free slot that fit best, again and again.
std::vector<int> plain_slots(std::span<const Vec3d> centers, const Vec3d& middle, int width) {
  std::vector<int> slots(centers.size(), -1);
  std::vector<bool> is_taken(static_cast<std::size_t>(width));
  for (std::size_t placed = 0; placed < centers.size(); ++placed) {
    double best = -Aabb::kInf;
    std::size_t best_child = 0, best_slot = 0;
    for (std::size_t child = 0; child < centers.size(); ++child)
      for (std::size_t slot = 0; slot < is_taken.size(); ++slot) {
        if (slots[child] >= 0 || is_taken[slot]) continue;
        const std::size_t octant = slot / (is_taken.size() / 8);
        const Vec3d offset = centers[child] - middle;
        const double fit = ((octant & 1u) != 0 ? offset.x : -offset.x) +
                           ((octant & 2u) != 0 ? offset.y : -offset.y) +
                           ((octant & 4u) != 0 ? offset.z : -offset.z);
        if (fit > best) best = fit, best_child = child, best_slot = slot;
      }
    slots[best_child] = static_cast<int>(best_slot), is_taken[best_slot] = true;
  }
  return slots;
}

TEST(WideOrder, FillsTheSlotsThatFitBest) {
  Rng rng(2);
  for (const int width : {8, 16})
    for (int round = 0; round < 300; ++round) {
      std::vector<Vec3d> centers(2 + rng.below(static_cast<std::uint32_t>(width) - 1));
      for (Vec3d& center : centers)  // of few values, so that many fit equally well
        for (int a = 0; a < 3; ++a) center[a] = static_cast<double>(rng.below(5)) - 2.0;
      const Vec3d middle{0, round % 2 == 0 ? 0.0 : 0.5, 0};
      std::vector<int> slots(centers.size());
      assign_slots(centers, middle, width, slots);
      ASSERT_EQ(slots, plain_slots(centers, middle, width)) << round;
    }
}

}  // namespace
}  // namespace strahl
