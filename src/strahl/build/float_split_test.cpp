#include <algorithm>
#include <cmath>
#include <tests/support/same_tree.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/build/float_clusters.h>
#include <strahl/build/float_split.h>
#include <strahl/build/float_tree.h>

namespace strahl {
namespace {

FloatRef ref_of(const Aabb& box, std::uint32_t reference, std::uint32_t weight = 1) {
  FloatRef ref{};
  for (int a = 0; a < 3; ++a) {
    ref.lo[a] = static_cast<float>(box.lo[a]) + 0.0f;
    ref.minus_hi[a] = -(static_cast<float>(box.hi[a]) + 0.0f);
  }
  ref.reference = reference, ref.weight = weight;
  return ref;
}

std::vector<FloatRef> strewn(std::size_t count, double size, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<FloatRef> refs;
  for (std::size_t i = 0; i < count; ++i) {
    Aabb box;
    for (int a = 0; a < 3; ++a) {
      box.lo[a] = rng.uniform(-1, 1);
      box.hi[a] = box.lo[a] + rng.uniform(0, size);
    }
    refs.push_back(ref_of(box, static_cast<std::uint32_t>(i)));
  }
  return refs;
}

Aabb center_of(const FloatRef& ref) {
  Aabb box;
  const Float4 center = ref.box().doubled_center();
  box.extend({double{center[0]}, double{center[1]}, double{center[2]}});
  return box;
}

/// Cost of a division into the references of two ranges, as FloatSplit::cost.
double cost_of(std::span<const FloatRef> refs) {
  Aabb box;
  double weight = 0;
  for (const FloatRef& ref : refs) box.extend(ref.box().box()), weight += ref.weight;
  return box.half_area() * weight;
}

/// A set as it should be: boxes tight, in the order given.
void expect_bounded(const FloatSplitter& splitter, const FloatSet& set) {
  Aabb box, centers;
  for (const FloatRef& ref : splitter.refs_of(set))
    box.extend(ref.box().box()), centers.extend(center_of(ref));
  EXPECT_EQ(set.box.box(), box);
  EXPECT_EQ(set.centers.box(), centers);
}

/// The cheapest of all divisions by equal bins of the centres, one after the other.
double cheapest(std::span<const FloatRef> refs, const FloatSet& set, int bins) {
  double best = Aabb::kInf;
  for (int axis = 0; axis < 3; ++axis)
    for (int b = 1; b < bins; ++b) {
      std::vector<FloatRef> sides[2];
      const float least = set.centers.lo[axis];
      const float per_unit = static_cast<float>(bins) / set.centers.extent()[axis];
      for (const FloatRef& ref : refs)
        sides[(ref.doubled_center(axis) - least) * per_unit >= static_cast<float>(b)].push_back(
            ref);
      if (sides[0].empty() || sides[1].empty()) continue;
      best = std::min(best, cost_of(sides[0]) + cost_of(sides[1]));
    }
  return best;
}

TEST(FloatSplit, FindsTheCheapestDivisionAndCarriesItOut) {
  for (const bool are_weighted : {false, true})
    for (const std::size_t count : {2u, 3u, 9u, 40u, 300u})
      for (std::uint64_t seed = 0; seed < 20; ++seed) {
        std::vector<FloatRef> refs = strewn(count, seed % 2 == 0 ? 0.1 : 1.0, seed);
        Rng rng(seed);
        if (are_weighted)
          for (FloatRef& ref : refs) ref.weight = 1 + static_cast<std::uint32_t>(rng.below(9));
        const std::vector<FloatRef> given = refs;
        std::vector<FloatRef> room(count);
        const FloatSplitter splitter(refs, room, 16, are_weighted);
        const FloatSet whole = splitter.bounded(0, static_cast<std::uint32_t>(count));
        expect_bounded(splitter, whole);
        const FloatSplit split = splitter.find(whole);
        const int bins = std::min(16, static_cast<int>(count / 2 + 4));
        const double best = cheapest(given, whole, bins);
        ASSERT_TRUE(split.is_found());
        ASSERT_NEAR(split.cost, best, 1e-5 * best);
        const auto [left, right] = splitter.divide(whole, split);
        expect_bounded(splitter, left), expect_bounded(splitter, right);
        EXPECT_NEAR(cost_of(splitter.refs_of(left)) + cost_of(splitter.refs_of(right)), best,
                    1e-5 * best);
        EXPECT_EQ(left.size(), split.left_count);
        EXPECT_EQ(right.begin, left.end);
        std::uint32_t weight = 0;
        for (const FloatRef& ref : splitter.refs_of(left)) weight += ref.weight;
        EXPECT_EQ(weight, split.left_weight);
        for (const FloatSet& side : {left, right})
          for (std::size_t i = 1; i < side.size(); ++i)
            EXPECT_LT(splitter.refs_of(side)[i - 1].reference, splitter.refs_of(side)[i].reference);
      }
}

TEST(FloatSplit, HalvesByTheOrderOfCentres) {
  for (const std::size_t count : {2u, 3u, 100u}) {
    std::vector<FloatRef> refs = strewn(count, 0.5, count), room(count);
    const FloatSplitter splitter(refs, room, 8, false);
    const FloatSet whole = splitter.bounded(0, static_cast<std::uint32_t>(count));
    const auto [left, right] = splitter.halve(whole);
    expect_bounded(splitter, left), expect_bounded(splitter, right);
    EXPECT_EQ(left.size(), count / 2);
    const Aabb low = left.centers.box(), high = right.centers.box();
    EXPECT_LE(low.hi[whole.centers.box().longest_axis()],
              high.lo[whole.centers.box().longest_axis()]);
  }
}

/// Parts of one thing have one reference, and may have one centre.
TEST(FloatSplit, HalvesReferencesThatRepeatAndLeavesAGap) {
  std::vector<FloatRef> refs, room(120);
  for (std::uint32_t i = 0; i < 100; ++i)
    refs.push_back(ref_of({Vec3d::all(-1.0 - i), Vec3d::all(1.0 + i)}, 7));
  refs.resize(120);
  const FloatSplitter splitter(refs, room, 8, false);
  const auto [left, right] = splitter.halve(splitter.bounded(0, 100), 20);
  expect_bounded(splitter, left), expect_bounded(splitter, right);
  EXPECT_EQ(left.size(), 50u);
  EXPECT_EQ(right.begin, 70u);
  EXPECT_EQ(right.size(), 50u);
  EXPECT_EQ(right.box.box().hi, Vec3d::all(100.0));
}

TEST(FloatSplit, FindsNoneWhereCentresCoincide) {
  std::vector<FloatRef> refs, room(10);
  for (std::uint32_t i = 0; i < 10; ++i)
    refs.push_back(ref_of({Vec3d::all(-1.0 - i), Vec3d::all(1.0 + i)}, i));
  const FloatSplitter splitter(refs, room, 8, false);
  EXPECT_FALSE(splitter.find(splitter.bounded(0, 10)).is_found());
}

/// Extents at which reciprocals, areas or both leave the range of floats.
TEST(FloatSplit, StandsAnyExtent) {
  for (const double size : {1e-44, 1e-38, 1e-25, 1e-12, 1e6, 4e6}) {
    std::vector<FloatRef> refs, room(64);
    for (std::uint32_t i = 0; i < 64; ++i)
      refs.push_back(ref_of({{size * (i % 4), size * (i / 4 % 4), size * (i / 16)},
                             {size * (i % 4), size * (i / 4 % 4), size * (i / 16)}},
                            i));
    const FloatSplitter splitter(refs, room, 32, false);
    const FloatSet whole = splitter.bounded(0, 64);
    const FloatSplit split = splitter.find(whole);
    if (!split.is_found()) continue;
    const auto [left, right] = splitter.divide(whole, split);
    expect_bounded(splitter, left), expect_bounded(splitter, right);
    EXPECT_EQ(left.size() + right.size(), 64u);
    EXPECT_NE(left.size(), 0u);
    EXPECT_NE(right.size(), 0u);
  }
}

std::uint32_t cell_of(const FloatRef& ref, const Aabb& centers, int axis) {
  const double longest = norm_max(centers.extent());
  const double place = (center_of(ref).lo[axis] - centers.lo[axis]) * (1024 / longest);
  return static_cast<std::uint32_t>(std::min(place, 1023.0));
}

TEST(FloatClusters, HoldAllThingsOnceAlongTheCurve) {
  for (const std::size_t count : {1u, 2u, 100u, 5000u}) {
    const std::vector<FloatRef> refs = strewn(count, 0.1, 3);
    Aabb centers;
    for (const FloatRef& ref : refs) centers.extend(center_of(ref));
    const FloatBox box = FloatSplitter({const_cast<FloatRef*>(refs.data()), count}, {}, 8, false)
                             .bounded(0, static_cast<std::uint32_t>(count))
                             .centers;
    const FloatClusters made = make_clusters(refs, box, 8, {});
    std::vector<int> seen(count);
    std::uint32_t next = 0;
    std::uint64_t last_code = 0;
    for (const FloatRef& cluster : made.clusters) {
      ASSERT_EQ(cluster.reference, next);
      next += cluster.weight;
      EXPECT_LE(cluster.weight, 8u);
      Aabb bounds;
      for (std::uint32_t i = cluster.reference; i < next; ++i) {
        const FloatRef& ref = made.sorted[i];
        ++seen[ref.reference], bounds.extend(ref.box().box());
        std::uint64_t code = 0;
        for (int bit = 9; bit >= 0; --bit)
          for (int axis = 0; axis < 3; ++axis)
            code = code << 1 | (cell_of(ref, centers, axis) >> bit & 1u);
        EXPECT_LE(last_code, code);
        last_code = code;
      }
      EXPECT_EQ(cluster.box().box(), bounds);
    }
    EXPECT_EQ(next, count);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(count));
  }
}

TEST(FloatClusters, KeepOneCellTogether) {
  std::vector<FloatRef> refs;
  for (std::uint32_t i = 0; i < 100; ++i) refs.push_back(ref_of({{1, 1, 1}, {2, 2, 2}}, i));
  const FloatBox centers{{3, 3, 3, 0}, {-3, -3, -3, 0}};
  const FloatClusters made = make_clusters(refs, centers, 8, {});
  ASSERT_EQ(made.clusters.size(), 1u);
  for (std::uint32_t i = 0; i < 100; ++i) EXPECT_EQ(made.sorted[i].reference, i);
}

FloatTreeRules rules_with(std::uint32_t cluster, std::size_t undivided = 3) {
  FloatTreeRules rules;
  rules.cluster = cluster, rules.opened = cluster > 0 ? 40 : 0, rules.undivided = undivided;
  return rules;
}

void expect_tree_over(const std::vector<FloatRef>& refs, const Tree& tree,
                      const FloatTreeRules& rules) {
  std::vector<int> seen(refs.size());
  std::size_t first = 0;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    Aabb box;
    if (node.is_leaf()) {
      EXPECT_EQ(node.first, first);
      EXPECT_LE(node.count, rules.undivided);
      for (std::size_t r = first; r < first + node.count; ++r) {
        ++seen[tree.references[r]], box.extend(refs[tree.references[r]].box().box());
        if (r > first) {
          EXPECT_LT(tree.references[r - 1], tree.references[r]);
        }
      }
      first += node.count;
    } else {
      box = Aabb::join(tree.nodes[i + 1].box, tree.nodes[node.right].box);
    }
    ASSERT_EQ(node.box, box) << i;
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(refs.size()));
  EXPECT_LE(tree.depth(), rules.max_depth);
}

TEST(FloatTree, EnclosesEveryThingOnce) {
  for (const std::uint32_t cluster : {0u, 1u, 8u})
    for (const std::size_t count : {1u, 3u, 4u, 79u, 3000u}) {
      const std::vector<FloatRef> given = strewn(count, 0.05, count);
      std::vector<FloatRef> refs = given;
      const FloatTreeRules rules = rules_with(cluster);
      expect_tree_over(given, build_float_tree(refs, rules, {}), rules);
    }
}

TEST(FloatTree, HalvesWhatCannotBeDivided) {
  for (const std::uint32_t cluster : {0u, 8u}) {
    std::vector<FloatRef> given;
    for (std::uint32_t i = 0; i < 500; ++i)
      given.push_back(ref_of({Vec3d::all(-1.0 - i % 7), Vec3d::all(1.0 + i % 7)}, i));
    std::vector<FloatRef> refs = given;
    const FloatTreeRules rules = rules_with(cluster);
    const Tree tree = build_float_tree(refs, rules, {});
    expect_tree_over(given, tree, rules);
    EXPECT_LE(tree.depth(), 8);
  }
}

/// Points that come closer to each other by a factor each: SAH cuts off one or few at a time.
TEST(FloatTree, KeepsToItsDepth) {
  for (const std::uint32_t cluster : {0u, 2u}) {
    std::vector<FloatRef> given;
    for (std::uint32_t i = 0; i < 250; ++i) {
      const double x = std::ldexp(1.0, -static_cast<int>(i) / 2);
      given.push_back(ref_of({{x, x, x}, {x, x, x}}, i));
    }
    for (const int depth : {8, 9, 20}) {
      std::vector<FloatRef> refs = given;
      FloatTreeRules rules = rules_with(cluster, 1);
      rules.max_depth = depth;
      const Tree tree = build_float_tree(refs, rules, {});
      expect_tree_over(given, tree, rules);
      EXPECT_GE(tree.depth(), std::min(depth, 15));
    }
  }
}

TEST(FloatTree, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  BuildContext two;
  two.executor = Executor::with_threads(2);
  for (const std::uint32_t cluster : {0u, 4u}) {
    std::vector<FloatRef> a = strewn(100'000, 0.01, 5), b = a;
    const Tree serial = build_float_tree(a, rules_with(cluster), {});
    const Tree parallel = build_float_tree(b, rules_with(cluster), two);
    test::expect_same_tree(serial, parallel);
  }
}

}  // namespace
}  // namespace strahl
