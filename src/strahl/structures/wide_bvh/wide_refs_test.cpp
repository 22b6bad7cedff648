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

TEST(WideRefs, LeaveRoomForCuts) {
  const Scene scene = scene_at({5, 0, 0}, 1.0, 3000);
  WideRefs made = make_wide_refs(scene, {}, 0.1);
  EXPECT_EQ(made.count, 2000u);
  EXPECT_EQ(made.with_spare().size(), 2200u);
  EXPECT_EQ(make_wide_refs(scene, {}).with_spare().size(), 2000u);
}

TEST(WideThings, GiveCornersInTheFrame) {
  const Scene scene = scene_at({1e9, -1e9, 0}, 1.0, 100);
  const WideFrame frame = make_wide_refs(scene, {}).frame;
  const WideThings things(scene, frame);
  EXPECT_EQ(things.rounding(), frame.rounding());
  EXPECT_EQ(things.reach(), frame.reach);
  std::array<Vec3d, 3> corners;
  TriangleVertices triangle;
  for (std::uint32_t i = 0; i < scene.size(); ++i) {
    ASSERT_EQ(things.corners(i, corners), scene.triangle(i, triangle));
    if (!scene.triangle(i, triangle)) continue;
    EXPECT_EQ(corners[0], frame.to_frame(triangle.a));
    EXPECT_EQ(corners[1], frame.to_frame(triangle.b));
    EXPECT_EQ(corners[2], frame.to_frame(triangle.c));
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

double fit(const Vec3d& offset, int slot, int width) {
  const int octant = slot / (width / 8);
  return ((octant & 1) != 0 ? offset.x : -offset.x) + ((octant & 2) != 0 ? offset.y : -offset.y) +
         ((octant & 4) != 0 ? offset.z : -offset.z);
}

/// The pair of child and free slot that fit best, again and again: how well all fit.
double greedy_fit(std::span<const Vec3d> offsets, int width) {
  std::vector<bool> is_placed(offsets.size()), is_taken(static_cast<std::size_t>(width));
  double sum = 0.0;
  for (std::size_t placed = 0; placed < offsets.size(); ++placed) {
    double best = -Aabb::kInf;
    std::size_t best_child = 0, best_slot = 0;
    for (std::size_t child = 0; child < offsets.size(); ++child)
      for (std::size_t slot = 0; slot < is_taken.size(); ++slot) {
        if (is_placed[child] || is_taken[slot]) continue;
        const double here = fit(offsets[child], static_cast<int>(slot), width);
        if (here > best) best = here, best_child = child, best_slot = slot;
      }
    sum += best;
    is_placed[best_child] = is_taken[best_slot] = true;
  }
  return sum;
}

/// Whether a child would fit better elsewhere, or two in each other's place.
bool can_improve(std::span<const Vec3d> offsets, std::span<const int> slots, int width) {
  std::vector<int> holder(static_cast<std::size_t>(width), -1);
  for (std::size_t child = 0; child < slots.size(); ++child)
    holder[static_cast<std::size_t>(slots[child])] = static_cast<int>(child);
  for (std::size_t child = 0; child < slots.size(); ++child)
    for (int slot = 0; slot < width; ++slot) {
      const int other = holder[static_cast<std::size_t>(slot)];
      double gain = fit(offsets[child], slot, width) - fit(offsets[child], slots[child], width);
      if (other >= 0) {
        const Vec3d& at = offsets[static_cast<std::size_t>(other)];
        gain += fit(at, slots[child], width) - fit(at, slot, width);
      }
      if (gain > 1e-3) return true;
    }
  return false;
}

TEST(WideOrder, FillsTheSlotsThatFitBest) {
  Rng rng(2);
  int better = 0;
  for (const int width : {8, 16})
    for (int round = 0; round < 300; ++round) {
      std::vector<Vec3d> centers(2 + rng.below(static_cast<std::uint32_t>(width) - 1));
      for (Vec3d& center : centers)  // of few values, so that many fit equally well
        for (int a = 0; a < 3; ++a) center[a] = static_cast<double>(rng.below(5)) - 2.0;
      const Vec3d middle{0, round % 2 == 0 ? 0.0 : 0.5, 0};
      std::vector<int> slots(centers.size());
      assign_slots(centers, middle, width, slots);
      double sum = 0.0;
      std::uint32_t taken = 0;
      for (std::size_t i = 0; i < centers.size(); ++i) {
        centers[i] = centers[i] - middle;
        sum += fit(centers[i], slots[i], width);
        ASSERT_EQ(taken >> slots[i] & 1u, 0u) << round;
        taken |= 1u << slots[i];
      }
      const double greedy = greedy_fit(centers, width);
      ASSERT_GE(sum, greedy - 1e-9) << round;
      better += sum > greedy + 1e-9;
      EXPECT_FALSE(can_improve(centers, slots, width)) << round;
    }
  EXPECT_GT(better, 20);
}

}  // namespace
}  // namespace strahl
