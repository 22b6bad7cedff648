#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/build/object_split.h>
#include <strahl/build/object_tree.h>
#include <strahl/build/reinsert_top.h>

namespace strahl {
namespace {

/// Needles that lie across each other, divided by the median: much to gain, several per leaf.
Tree poor_tree(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<PrimRef> refs;
  Aabb all;
  for (std::size_t i = 0; i < count; ++i) {
    Vec3d lo{rng.uniform(), rng.uniform(), rng.uniform()}, hi = lo + Vec3d::all(0.01);
    hi[static_cast<int>(rng.below(3))] += rng.uniform(0.0, 0.5);
    refs.push_back({{lo, hi}, static_cast<std::uint32_t>(i)});
    all.extend(refs.back().box);
  }
  const auto splitter = make_median_splitter(refs, MedianAxis::longest, {1.0, 1.0});
  return build_object_tree(*splitter, count, all, {{1.0, 1.0}, 3, 64}, {});
}

double inner_area(const Tree& tree) {
  double sum = 0.0;
  for (const TreeNode& node : tree.nodes)
    if (!node.is_leaf()) sum += node.box.half_area();
  return sum;
}

/// Leaves by their references, and that everything else is as a Tree should be.
std::map<std::vector<std::uint32_t>, Aabb> leaves_of(const Tree& tree) {
  std::map<std::vector<std::uint32_t>, Aabb> leaves;
  std::size_t first = 0;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    if (!node.is_leaf()) {
      EXPECT_EQ(node.box, Aabb::join(tree.nodes[i + 1].box, tree.nodes[node.right].box));
      continue;
    }
    EXPECT_EQ(node.first, first);
    const auto begin = tree.references.begin() + node.first;
    leaves[{begin, begin + node.count}] = node.box;
    first += node.count;
  }
  EXPECT_EQ(first, tree.references.size());
  return leaves;
}

TEST(ReinsertTop, LowersTheAreaAndKeepsTheLeaves) {
  for (const std::uint32_t whole : {1u, 3u, 15u, 5000u}) {
    const Tree before = poor_tree(3000, 1);
    TopRules rules;
    rules.whole = whole, rules.least_overlap = 0.0;
    const Tree after = reinsert_top(before, rules, {});
    EXPECT_EQ(leaves_of(after), leaves_of(before));
    EXPECT_EQ(after.nodes.size(), before.nodes.size());
    if (whole == 5000)
      EXPECT_EQ(inner_area(after), inner_area(before));
    else
      EXPECT_LT(inner_area(after), 0.995 * inner_area(before)) << whole;
  }
}

TEST(ReinsertTop, LeavesGoodTreesAndDepthsAlone) {
  const Tree before = poor_tree(2000, 2);
  TopRules rules;
  rules.least_overlap = 0.9;
  EXPECT_EQ(inner_area(reinsert_top(before, rules, {})), inner_area(before));
  rules.least_overlap = 0.0, rules.whole = 1;
  const Tree free = reinsert_top(before, rules, {});
  ASSERT_GT(free.depth(), before.depth());
  rules.max_depth = free.depth() - 1;
  EXPECT_EQ(inner_area(reinsert_top(before, rules, {})), inner_area(before));
}

TEST(ReinsertTop, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  BuildContext two;
  two.executor = Executor::with_threads(2);
  const Tree before = poor_tree(10'000, 3);
  const Tree a = reinsert_top(before, {}, {}), b = reinsert_top(before, {}, two);
  EXPECT_NE(inner_area(a), inner_area(before));
  EXPECT_EQ(a.references, b.references);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) ASSERT_EQ(a.nodes[i].box, b.nodes[i].box);
}

TEST(ReinsertTop, KeepsToTheMemoryLimit) {
  BuildContext small;
  small.memory_limit = 1000;
  EXPECT_THROW(reinsert_top(poor_tree(1000, 4), {}, small), Error);
}

}  // namespace
}  // namespace strahl
