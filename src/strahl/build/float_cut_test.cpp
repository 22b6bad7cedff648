#include <algorithm>
#include <array>
#include <cmath>
#include <tests/support/same_tree.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/build/float_cut.h>
#include <strahl/build/float_tree.h>
#include <strahl/geometry/triangle.h>
#include <strahl/math/float_round.h>

namespace strahl {
namespace {

constexpr double kReach = 4.0;

/// Triangles whose corners are handed out up to `error` away.
struct Triangles final : FloatThings {
  std::vector<std::array<Vec3d, 3>> all;
  double error = 0.0;
  bool are_boxes = false;  ///< hides the corners

  bool corners(std::uint32_t i, std::array<Vec3d, 3>& out) const override {
    if (are_boxes) return false;
    out = all[i];
    Rng rng(i);
    for (Vec3d& corner : out)
      for (int a = 0; a < 3; ++a) corner[a] += rng.below(2) == 0 ? error : -error;
    return true;
  }
  double rounding() const override { return error; }
  double reach() const override { return kReach; }

  FloatRef ref(std::uint32_t i) const {
    FloatRef ref{};
    Aabb box;
    for (const Vec3d& corner : all[i]) box.extend(corner);
    for (int a = 0; a < 3; ++a) {
      ref.lo[a] = float_below(box.lo[a]), ref.minus_hi[a] = -float_above(box.hi[a]);
    }
    ref.reference = i, ref.weight = 1;
    return ref;
  }
  std::vector<FloatRef> refs() const {
    std::vector<FloatRef> refs;
    for (std::uint32_t i = 0; i < all.size(); ++i) refs.push_back(ref(i));
    return refs;
  }
};

Vec3d random_point(Rng& rng, double size) {
  return {rng.uniform(-size, size), rng.uniform(-size, size), rng.uniform(-size, size)};
}

/// Slender ones across everything and small ones.
Triangles strewn(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  Triangles things;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d a = random_point(rng, 1);
    const Vec3d b = a + random_point(rng, i % 4 == 0 ? 1.0 : 0.05);
    things.all.push_back({a, b, b + random_point(rng, 0.02)});
  }
  return things;
}

using Exact = std::array<long double, 3>;

/// A point of a triangle, to the precision of long doubles.
Exact point_of(const std::array<Vec3d, 3>& t, long double u, long double v) {
  Exact p;
  for (int a = 0; a < 3; ++a)
    p[static_cast<std::size_t>(a)] = t[0][a] + u * (static_cast<long double>(t[1][a]) - t[0][a]) +
                                     v * (static_cast<long double>(t[2][a]) - t[0][a]);
  return p;
}

bool contains(const FloatBox& box, const Exact& p) {
  for (int a = 0; a < 3; ++a) {
    const long double x = p[static_cast<std::size_t>(a)];
    if (!(box.lo[a] <= x && x <= -box.minus_hi[a])) return false;
  }
  return true;
}

/// Corners, points of edges where they cross the plane and some inside.
std::vector<Exact> points_of(const std::array<Vec3d, 3>& t, int axis, float plane, Rng& rng) {
  std::vector<Exact> points{point_of(t, 0, 0), point_of(t, 1, 0), point_of(t, 0, 1)};
  for (std::size_t i = 0; i < 3; ++i) {
    const long double from = t[i][axis], to = t[(i + 1) % 3][axis];
    if (!((from < plane && plane < to) || (to < plane && plane < from))) continue;
    const long double part = (plane - from) / (to - from);
    points.push_back(point_of({t[i], t[(i + 1) % 3], t[i]}, part, 0));
    points.back()[static_cast<std::size_t>(axis)] = plane;
  }
  for (int i = 0; i < 20; ++i) {
    const double u = rng.uniform();
    points.push_back(point_of(t, u, (1 - u) * rng.uniform()));
  }
  return points;
}

/// Every third one has an edge that is nearly parallel to planes across x.
std::array<Vec3d, 3> random_triangle(Rng& rng, int round) {
  std::array<Vec3d, 3> t{random_point(rng, 1), random_point(rng, 1), random_point(rng, 1)};
  if (round % 3 == 0) t[1].x = t[0].x + rng.uniform(-3e-9, 3e-9);
  if (round % 3 == 1) t[2] = t[1] + 1e-4 * random_point(rng, 1);
  return t;
}

TEST(FloatCut, PartsHoldTheirSideOfATriangle) {
  Rng rng(1);
  for (const double error : {0.0, 1e-9})
    for (int round = 0; round < 6000; ++round) {
      Triangles things;
      things.all = {random_triangle(rng, round)};
      things.error = error;
      const auto& t = things.all[0];
      const FloatRef ref = things.ref(0);
      const int axis = round % 3 == 0 ? 0 : static_cast<int>(rng.below(3));
      const auto plane =
          static_cast<float>(round % 2 == 0 ? t[0][axis] : 0.5 * (t[1][axis] + t[2][axis]));
      const auto [low, high] = cut_box(things, ref, axis, plane);
      for (const Exact& p : points_of(t, axis, plane, rng)) {
        const long double x = p[static_cast<std::size_t>(axis)];
        if (x <= plane) {
          ASSERT_TRUE(contains(low, p)) << round;
        }
        if (x >= plane) {
          ASSERT_TRUE(contains(high, p)) << round;
        }
      }
    }
}

TEST(FloatCut, PartsAreTight) {
  Rng rng(2);
  for (int round = 0; round < 2000; ++round) {
    Triangles things;
    things.all = {{random_point(rng, 1), random_point(rng, 1), random_point(rng, 1)}};
    const auto& t = things.all[0];
    const FloatRef ref = things.ref(0);
    const int axis = static_cast<int>(rng.below(3));
    const float plane = 0.5f * (ref.lo[axis] - ref.minus_hi[axis]);
    const auto [low, high] = cut_box(things, ref, axis, plane);
    Aabb below = ref.box().box(), above = below;
    below.hi[axis] = above.lo[axis] = plane;
    for (const auto& [part, side] : {std::pair(low, below), std::pair(high, above)}) {
      const Aabb best = clip(TriangleVertices{t[0], t[1], t[2]}, side), held = part.box();
      EXPECT_LT(norm_max(held.lo - best.lo), 1e-6);
      EXPECT_LT(norm_max(held.hi - best.hi), 1e-6);
    }
  }
}

TEST(FloatCut, CutsTheBoxOfWhatIsNoTriangle) {
  Triangles things;
  things.all = {{Vec3d{0, 0, 0}, Vec3d{1, 1, 1}, Vec3d{1, 1, 1}}};
  things.are_boxes = true;
  const auto [low, high] = cut_box(things, things.ref(0), 1, 0.25f);
  EXPECT_EQ(low.box(), (Aabb{{0, 0, 0}, {1, 0.25, 1}}));
  EXPECT_EQ(high.box(), (Aabb{{0, 0.25, 0}, {1, 1, 1}}));
}

/// A set of references divided by a plane, their boxes cut.
struct BoxesCut {
  Aabb left, right;
  std::size_t left_count = 0, right_count = 0;

  BoxesCut(std::span<const FloatRef> refs, int axis, double plane) {
    for (const FloatRef& ref : refs) {
      Aabb low = ref.box().box(), high = low;
      const bool is_left = low.lo[axis]<plane, is_right = high.hi[axis]> plane;
      if (is_left && is_right) low.hi[axis] = high.lo[axis] = plane;
      if (is_left) left.extend(low), ++left_count;
      if (is_right) right.extend(high), ++right_count;
    }
  }
  double cost() const {
    return left.half_area() * static_cast<double>(left_count) +
           right.half_area() * static_cast<double>(right_count);
  }
};

double cheapest(std::span<const FloatRef> refs, const FloatSet& set, int bins, std::size_t spare) {
  double best = Aabb::kInf;
  const Vec3d extent = set.box.box().extent();
  for (int axis = 0; axis < 3; ++axis) {
    if (extent[axis] < 0.2 * norm_max(extent)) continue;
    for (int b = 1; b < bins; ++b) {
      const float width = set.box.extent()[axis] / static_cast<float>(bins);
      const BoxesCut cut(refs, axis, double{set.box.lo[axis] + static_cast<float>(b) * width});
      if (cut.left_count == refs.size() || cut.right_count == refs.size()) continue;
      if (cut.left_count + cut.right_count > refs.size() + spare) continue;
      best = std::min(best, cut.cost());
    }
  }
  return best;
}

TEST(FloatCut, FindsTheCheapestPlaneThatItsPlacesAllow) {
  for (const std::size_t count : {20u, 100u, 400u})
    for (std::uint64_t seed = 0; seed < 10; ++seed)
      for (const std::uint32_t spare : {0u, 3u, 1000u}) {
        const Triangles things = strewn(count, seed);
        std::vector<FloatRef> refs = things.refs(), other(count);
        const FloatSplitter splitter(refs, other, 16, false);
        const FloatSet whole = splitter.bounded(0, static_cast<std::uint32_t>(count));
        const int bins = std::min(16, static_cast<int>(count / 2 + 4));
        const FloatCut cut = FloatCutter(splitter, things, 16).find(whole, spare);
        const double best = cheapest(refs, whole, bins, spare);
        ASSERT_EQ(cut.is_found(), best < Aabb::kInf);
        if (!cut.is_found()) continue;
        EXPECT_NEAR(cut.cost, best, 1e-4 * best);
        EXPECT_LE(cut.left + cut.right, count + spare);
      }
}

void expect_bounded(const FloatSplitter& splitter, const FloatSet& set) {
  Aabb box, centers;
  for (const FloatRef& ref : splitter.refs_of(set)) {
    const Float4 center = ref.box().doubled_center();
    box.extend(ref.box().box());
    centers.extend({double{center[0]}, double{center[1]}, double{center[2]}});
  }
  EXPECT_EQ(set.box.box(), box);
  EXPECT_EQ(set.centers.box(), centers);
}

TEST(FloatCut, SidesCoverAllThingsAndKeepToTheirPlaces) {
  std::size_t cut_ones = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Triangles things = strewn(200, seed);
    std::vector<FloatRef> refs = things.refs(), other(300);
    refs.resize(300);
    const FloatSplitter splitter(refs, other, 16, false);
    const FloatSet whole = splitter.bounded(0, 200);
    const FloatCutter cutter(splitter, things, 16);
    const FloatCut cut = cutter.find(whole, 60);
    ASSERT_TRUE(cut.is_found());
    const std::uint32_t right_begin = cut.left + 20;
    const auto [left, right] = cutter.divide(whole, cut, right_begin);
    expect_bounded(splitter, left), expect_bounded(splitter, right);
    EXPECT_EQ(left.begin, 0u);
    EXPECT_EQ(right.begin, right_begin);
    EXPECT_LE(left.size(), cut.left);
    EXPECT_LE(right.size(), cut.right);
    EXPECT_LT(std::max(left.size(), right.size()), 200u);
    cut_ones += left.size() + right.size() - 200;
    Rng rng(seed);
    std::vector<std::vector<FloatBox>> parts(200);
    for (const FloatSet& side : {left, right})
      for (const FloatRef& ref : splitter.refs_of(side)) parts[ref.reference].push_back(ref.box());
    for (std::uint32_t i = 0; i < 200; ++i)
      for (const Exact& p : points_of(things.all[i], cut.axis, cut.plane, rng))
        ASSERT_TRUE(std::any_of(parts[i].begin(), parts[i].end(),
                                [&](const FloatBox& box) { return contains(box, p); }));
  }
  EXPECT_GT(cut_ones, 20u);
}

Tree cut_tree(const Triangles& things, std::size_t spare, const FloatTreeRules& rules = {},
              const BuildContext& context = {}) {
  std::vector<FloatRef> room = things.refs();
  room.resize(room.size() + spare);
  return build_cut_float_tree(room, things.all.size(), rules, {}, things, context);
}

TEST(FloatCutTree, LeavesCoverAllThingsWithinTheRoom) {
  const Triangles things = strewn(3000, 5);
  for (const std::size_t spare : {0u, 300u, 600u}) {
    const Tree tree = cut_tree(things, spare);
    EXPECT_LE(tree.references.size(), 3000 + spare);
    EXPECT_EQ(tree.references.size() > 3000, spare > 0);
    std::vector<std::vector<Aabb>> parts(3000);
    for (const TreeNode& node : tree.nodes)
      for (std::uint32_t r = node.first; r < node.first + node.count; ++r)
        parts[tree.references[r]].push_back(node.box);
    Rng rng(6);
    for (std::uint32_t i = 0; i < 3000; ++i)
      for (int n = 0; n < 30; ++n) {
        const double u = rng.uniform();
        const Exact p = point_of(things.all[i], u, (1 - u) * rng.uniform());
        const auto holds = [&](const Aabb& box) {
          return box.lo.x <= p[0] && p[0] <= box.hi.x && box.lo.y <= p[1] && p[1] <= box.hi.y &&
                 box.lo.z <= p[2] && p[2] <= box.hi.z;
        };
        ASSERT_TRUE(std::any_of(parts[i].begin(), parts[i].end(), holds)) << i;
      }
  }
}

TEST(FloatCutTree, CostsLessThanWithoutCuts) {
  const Triangles things = strewn(3000, 7);
  const SahCost cost{1.0, 1.0};
  EXPECT_LT(cut_tree(things, 360).sah_cost(cost), 0.97 * cut_tree(things, 0).sah_cost(cost));
}

/// Large triangles around one point: each plane cuts them all, and parts coincide.
TEST(FloatCutTree, KeepsToItsDepth) {
  Triangles things;
  for (int i = 0; i < 500; ++i)
    things.all.push_back({Vec3d{-1, -1, -1}, Vec3d{1, 1, 1}, Vec3d{1, -1, 1}});
  for (const int depth : {10, 11, 64}) {
    FloatTreeRules rules;
    rules.max_depth = depth, rules.undivided = 1;
    const Tree tree = cut_tree(things, 500, rules);
    EXPECT_LE(tree.depth(), depth);
    EXPECT_GE(tree.references.size(), 500u);
  }
}

TEST(FloatCutTree, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  BuildContext two;
  two.executor = Executor::with_threads(2);
  const Triangles things = strewn(40'000, 8);
  const Tree serial = cut_tree(things, 4000), parallel = cut_tree(things, 4000, {}, two);
  EXPECT_GT(serial.references.size(), 41'000u);
  test::expect_same_tree(serial, parallel);
}

}  // namespace
}  // namespace strahl
