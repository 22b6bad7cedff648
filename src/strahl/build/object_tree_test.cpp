#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/build/object_tree.h>

namespace strahl {
namespace {

using Refs = std::vector<PrimRef>;

constexpr SahCost kCost{1.0, 1.0};

Aabb box_of(const Refs& refs) {
  Aabb box;
  for (const PrimRef& ref : refs) box.extend(ref.box);
  return box;
}

Refs numbered(const std::vector<Aabb>& boxes) {
  Refs refs;
  for (const Aabb& box : boxes) refs.push_back({box, static_cast<std::uint32_t>(refs.size())});
  return refs;
}

Refs random_refs(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d lo{rng.uniform(), rng.uniform(), rng.uniform()};
    boxes.push_back({lo, lo + Vec3d::all(rng.uniform(0, 0.05))});
  }
  return numbered(boxes);
}

enum class Splitter { sweep, binned };
constexpr Splitter kSplitters[] = {Splitter::sweep, Splitter::binned};

Tree build(Refs refs, Splitter kind, const LeafRules& rules, const BuildContext& context = {}) {
  const auto splitter = kind == Splitter::sweep ? make_sweep_splitter(refs, rules.cost)
                                                : make_binned_splitter(refs, 32, rules.cost);
  return build_object_tree(*splitter, refs.size(), box_of(refs), rules, context);
}

/// The invariants of tree.h, exact boxes, and the leaf rule.
struct TreeCheck {
  const Tree& tree;
  const Refs& refs;
  std::size_t max_leaf;
  std::size_t next_node = 0, next_reference = 0;

  void run() {
    visit();
    EXPECT_EQ(next_node, tree.nodes.size());
    EXPECT_EQ(next_reference, tree.references.size());
    std::vector<std::uint32_t> sorted = tree.references;
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(sorted.size(), refs.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], i);
  }

  /// Checks the subtree at next_node and returns the box of what lies in it.
  Aabb visit() {
    const TreeNode& node = tree.nodes[next_node++];
    Aabb box;
    if (node.is_leaf()) {
      box = leaf(node);
    } else {
      box = visit();
      EXPECT_EQ(node.right, next_node);
      box.extend(visit());
    }
    EXPECT_EQ(node.box, box);
    return box;
  }

  Aabb leaf(const TreeNode& node) {
    EXPECT_EQ(node.first, next_reference);
    EXPECT_LE(node.count, max_leaf);
    Aabb box;
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const std::uint32_t reference = tree.references[next_reference++];
      EXPECT_TRUE(i == 0 || tree.references[next_reference - 2] < reference);
      box.extend(refs[reference].box);
    }
    return box;
  }
};

void expect_equal(const Tree& a, const Tree& b) {
  EXPECT_EQ(a.references, b.references);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.nodes.size(); ++i)
    different += a.nodes[i].box != b.nodes[i].box || a.nodes[i].right != b.nodes[i].right ||
                 a.nodes[i].first != b.nodes[i].first || a.nodes[i].count != b.nodes[i].count;
  EXPECT_EQ(different, 0u);
}

struct Input {
  std::string name;
  Refs refs;
};

constexpr int kMany = 10000;

/// 10,000 boxes each on which a careless builder does not stop or goes deep.
std::vector<Input> degenerate_inputs() {
  std::vector<Aabb> same, point, points, series, nested;
  for (int i = 0; i < kMany; ++i) {
    const double x = std::ldexp(1.0, -(i % 240));
    same.push_back({{0, 0, 0}, {1, 2, 3}});
    point.push_back({{1, 2, 3}, {1, 2, 3}});
    points.push_back({Vec3d::all(i / 16), Vec3d::all(i / 16)});
    series.push_back({{x, 0, 0}, {x, 0, 0}});
    nested.push_back({Vec3d::all(-x), Vec3d::all(x)});
  }
  return {{"identical", numbered(same)},
          {"one point", numbered(point)},
          {"points on a diagonal", numbered(points)},
          {"positions 2^-i", numbered(series)},
          {"sizes 2^-i", numbered(nested)}};
}

TEST(ObjectTree, HoldsItsInvariants) {
  const Refs refs = random_refs(3000, 1);
  for (const Splitter splitter : kSplitters)
    for (const std::size_t max_leaf : {1u, 4u, 100u}) {
      const Tree tree = build(refs, splitter, {kCost, max_leaf, 64});
      TreeCheck{tree, refs, max_leaf}.run();
    }
}

TEST(ObjectTree, IsALeafForASinglePrimitive) {
  for (const Splitter splitter : kSplitters) {
    const Tree tree = build(random_refs(1, 2), splitter, {kCost, 1, 64});
    ASSERT_EQ(tree.nodes.size(), 1u);
    EXPECT_EQ(tree.nodes[0].count, 1u);
  }
}

TEST(ObjectTree, StopsWithinTheDepthBoundOnDegenerateInput) {
  for (const Input& input : degenerate_inputs())
    for (const Splitter splitter : kSplitters)
      for (const int max_depth : {16, 64}) {
        SCOPED_TRACE(input.name);
        const Tree tree = build(input.refs, splitter, {kCost, 1, max_depth});
        EXPECT_EQ(tree.nodes.size(), 2u * kMany - 1);
        EXPECT_LE(tree.depth(), max_depth);
        TreeCheck{tree, input.refs, 1}.run();
      }
}

TEST(ObjectTree, HalvesWhatTheDepthBoundLeavesNoOtherRoomFor) {
  std::vector<Aabb> boxes;
  for (int i = 0; i < 64; ++i) {
    const double x = std::ldexp(1.0, -i);
    boxes.push_back({{x, 0, 0}, {x, x, x}});
  }
  const Refs refs = numbered(boxes);
  EXPECT_GT(build(refs, Splitter::sweep, {kCost, 1, 64}).depth(), 6);
  for (int max_depth = 6; max_depth < 12; ++max_depth)
    EXPECT_LE(build(refs, Splitter::sweep, {kCost, 1, max_depth}).depth(), max_depth);
  EXPECT_EQ(build(refs, Splitter::sweep, {kCost, 1, 6}).depth(), 6);
}

TEST(ObjectTree, DividesNoSetThatIsCheaperAsALeaf) {
  const Refs refs = random_refs(100, 3);
  for (const Splitter splitter : kSplitters) {
    const SahCost dear{1e6, 1.0};
    EXPECT_EQ(build(refs, splitter, {dear, 100, 64}).nodes.size(), 1u);
    EXPECT_GT(build(refs, splitter, {dear, 99, 64}).nodes.size(), 1u);
    EXPECT_GT(build(refs, splitter, {{1e-6, 1.0}, 100, 64}).nodes.size(), 100u);
  }
}

TEST(ObjectTree, CostNeverPassesThatOfOneLeaf) {
  const Refs refs = random_refs(500, 4);
  for (const Splitter splitter : kSplitters) {
    const Tree tree = build(refs, splitter, {kCost, 500, 64});
    EXPECT_LT(tree.sah_cost(kCost), sah_leaf_cost(kCost, 500));
  }
}

TEST(ObjectTree, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  BuildContext two;
  two.executor = Executor::with_threads(2);
  std::vector<Input> all = degenerate_inputs();
  all.push_back({"random", random_refs(50000, 5)});
  for (const Input& input : all)
    for (const Splitter splitter : kSplitters) {
      SCOPED_TRACE(input.name);
      const LeafRules rules{kCost, 2, 64};
      expect_equal(build(input.refs, splitter, rules), build(input.refs, splitter, rules, two));
    }
}

TEST(ObjectTree, CanBeCancelled) {
  const Refs refs = random_refs(20000, 6);
  for (const Splitter splitter : kSplitters) {
    int calls = 0;
    double last = 0.0;
    BuildContext context;
    context.progress = [&](double fraction, std::string_view) {
      EXPECT_GE(fraction, last);
      last = fraction;
      return ++calls < 10;
    };
    try {
      build(refs, splitter, {kCost, 4, 64}, context);
      ADD_FAILURE() << "went on";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
    }
    EXPECT_EQ(calls, 10);
    EXPECT_LT(last, 0.2);
  }
}

}  // namespace
}  // namespace strahl
