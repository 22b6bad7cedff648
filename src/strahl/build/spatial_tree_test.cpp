#include <algorithm>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/build/collapse.h>
#include <strahl/build/object_split.h>
#include <strahl/build/object_tree.h>
#include <strahl/build/spatial_tree.h>

namespace strahl {
namespace {

/// Boxes that are what they bound.
struct Sticks final : PrimitiveSource {
  std::vector<Aabb> boxes;
  std::uint32_t size() const override { return static_cast<std::uint32_t>(boxes.size()); }
  Aabb bounds(std::uint32_t i) const override { return boxes[i]; }
  Aabb clip(std::uint32_t i, const Aabb& box) const override {
    return Aabb::intersection(boxes[i], box);
  }
  Aabb total() const {
    Aabb box;
    for (const Aabb& b : boxes) box.extend(b);
    return box;
  }
};

/// Long thin boxes along all axes.
Sticks sticks(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  Sticks source;
  for (std::size_t i = 0; i < count; ++i) {
    Vec3d lo{rng.uniform(), rng.uniform(), rng.uniform()}, hi = lo + Vec3d::all(0.005);
    hi[static_cast<int>(rng.below(3))] += rng.uniform(0.1, 0.6);
    source.boxes.push_back({lo, hi});
  }
  return source;
}

Tree cut_tree(const Sticks& source, const SpatialRules& rules, const BuildContext& context = {}) {
  return build_spatial_tree(source, make_prim_refs(source, context), source.total(), rules,
                            context);
}

Tree whole_tree(const Sticks& source) {
  std::vector<PrimRef> refs = make_prim_refs(source, {});
  const auto splitter = make_binned_splitter(refs, 32, {1.0, 1.0});
  return build_object_tree(*splitter, refs.size(), source.total(), {{1.0, 1.0}, 1, 64}, {});
}

TEST(SpatialTree, CoversEveryPrimitiveWithinItsGrowth) {
  const Sticks source = sticks(2000, 1);
  for (const double growth : {0.0, 0.1, 0.5}) {
    SpatialRules rules;
    rules.growth = growth;
    const Tree tree = cut_tree(source, rules);
    EXPECT_LE(static_cast<double>(tree.references.size()), 2000 * (1.0 + growth));
    EXPECT_EQ(tree.references.size() > 2000, growth > 0.0);
    std::vector<Aabb> covered(source.boxes.size());
    std::vector<double> volume(source.boxes.size(), 0.0);
    for (const TreeNode& node : tree.nodes) {
      if (!node.is_leaf()) continue;
      const std::uint32_t i = tree.references[node.first];
      const Aabb part = Aabb::intersection(node.box, source.boxes[i]);
      const Vec3d e = part.extent();
      covered[i].extend(part), volume[i] += e.x * e.y * e.z;
    }
    for (std::size_t i = 0; i < covered.size(); ++i) {
      const Vec3d e = source.boxes[i].extent();
      EXPECT_EQ(covered[i], source.boxes[i]);
      EXPECT_GE(volume[i], (1.0 - 1e-9) * e.x * e.y * e.z) << i;
    }
  }
}

TEST(SpatialTree, CostsLessThanWithoutCuts) {
  const Sticks source = sticks(2000, 2);
  const SahCost cost{1.0, 1.0};
  EXPECT_LT(cut_tree(source, {}).sah_cost(cost), 0.95 * whole_tree(source).sah_cost(cost));
}

TEST(SpatialTree, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const Sticks source = sticks(20000, 3);
  BuildContext two;
  two.executor = Executor::with_threads(2);
  const Tree a = cut_tree(source, {}), b = cut_tree(source, {}, two);
  ASSERT_EQ(a.references, b.references);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) ASSERT_EQ(a.nodes[i].box, b.nodes[i].box);
}

TEST(SpatialTree, KeepsTheDepthOnCoincidentInput) {
  Sticks source;
  for (int i = 0; i < 5000; ++i) source.boxes.push_back({{0, 0, 0}, {1, 2, 3}});
  EXPECT_LE(cut_tree(source, {}).depth(), 64);
}

/// Cost of the wide nodes and blocks chosen, by walking them.
double walked_cost(const Tree& tree, const Collapse& collapse, const CollapseRules& rules,
                   std::uint32_t node, std::size_t& blocks) {
  const double share = tree.nodes[node].box.half_area() / tree.nodes[0].box.half_area();
  if (collapse.is_block(node)) {
    ++blocks;
    const auto count = static_cast<double>(collapse.references(node).size());
    return share * (rules.leaf_cost + rules.primitive_cost * count);
  }
  std::array<std::uint32_t, CollapseRules::kMaxWidth> child;
  const int count = collapse.children(node, child);
  EXPECT_GE(count, 2);
  EXPECT_LE(count, rules.width);
  double sum = share * rules.node_cost;
  for (int i = 0; i < count; ++i)
    sum += walked_cost(tree, collapse, rules, child[static_cast<std::size_t>(i)], blocks);
  return sum;
}

TEST(Collapse, CostsWhatItSaysAndHoldsEveryReferenceOnce) {
  const Tree tree = whole_tree(sticks(3000, 4));
  for (const int width : {2, 8, 16}) {
    CollapseRules rules;
    rules.width = width;
    const Collapse collapse(tree, rules, {});
    std::size_t blocks = 0;
    EXPECT_NEAR(walked_cost(tree, collapse, rules, 0, blocks), collapse.cost(),
                1e-9 * collapse.cost());
    EXPECT_LT(blocks, 3000u);
    EXPECT_EQ(collapse.references(0).size(), 3000u);
  }
}

TEST(Collapse, IsCheaperTheMoreItMayChoose) {
  const Tree tree = whole_tree(sticks(1000, 5));
  double before = Aabb::kInf;
  for (const int width : {2, 3, 4, 8, 16}) {
    CollapseRules rules;
    rules.width = width;
    const double cost = Collapse(tree, rules, {}).cost();
    EXPECT_LT(cost, before) << width;
    before = cost;
  }
}

/// The recurrence for a subtree as 1, 2, ... children, without short cuts.
std::vector<double> plain_costs(const Tree& tree, const CollapseRules& rules, std::uint32_t node,
                                std::uint32_t& count) {
  const TreeNode& at = tree.nodes[node];
  const double share = at.box.half_area() / tree.nodes[0].box.half_area();
  const auto width = static_cast<std::size_t>(rules.width);
  std::vector<double> costs(width + 1, Aabb::kInf);
  if (!at.is_leaf()) {
    std::uint32_t left_count, right_count;
    const auto left = plain_costs(tree, rules, node + 1, left_count);
    const auto right = plain_costs(tree, rules, at.right, right_count);
    count = left_count + right_count;
    for (std::size_t j = 2; j <= width; ++j)
      for (std::size_t k = 1; k < j; ++k) costs[j] = std::min(costs[j], left[k] + right[j - k]);
    costs[1] = share * rules.node_cost + costs[width];
  } else {
    count = at.count;
  }
  if (count <= rules.max_leaf)
    costs[1] = std::min(costs[1], share * (rules.leaf_cost + rules.primitive_cost * count));
  for (std::size_t j = 2; j <= width; ++j) costs[j] = std::min(costs[j], costs[j - 1]);
  return costs;
}

TEST(Collapse, IsTheCheapestForAnyNumberOfThreads) {
  BuildContext two;
  if (Executor::threads_available()) two.executor = Executor::with_threads(2);
  for (const std::size_t count : {3u, 40u, 9000u}) {
    const Tree tree = whole_tree(sticks(count, 6));
    for (const int width : {2, 5, 8, 16}) {
      CollapseRules rules;
      rules.width = width;
      std::uint32_t all;
      const double expected = plain_costs(tree, rules, 0, all)[1];
      EXPECT_NEAR(Collapse(tree, rules, {}).cost(), expected, 1e-12 * expected);
      EXPECT_NEAR(Collapse(tree, rules, two).cost(), expected, 1e-12 * expected);
    }
  }
}

TEST(Collapse, TakesTheOptimumOfFourLeaves) {
  // Two pairs: far apart, so that one node of four children is cheaper than three of two.
  Sticks source;
  for (const double x : {0.0, 1.1, 8.0, 9.1}) source.boxes.push_back({{x, 0, 0}, {x + 1, 1, 1}});
  const Tree tree = whole_tree(source);
  CollapseRules rules;
  rules.width = 4, rules.max_leaf = 1;
  const Collapse collapse(tree, rules, {});
  std::array<std::uint32_t, CollapseRules::kMaxWidth> child;
  EXPECT_EQ(collapse.children(0, child), 4);
  const double whole = tree.nodes[0].box.half_area();
  EXPECT_NEAR(collapse.cost(), 1.0 + 4 * 0.83 * 3.0 / whole, 1e-12);
}

}  // namespace
}  // namespace strahl
