#include <bit>
#include <cmath>
#include <memory>
#include <set>
#include <tests/support/tree_cases.h>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/build/morton_order.h>
#include <strahl/build/object_tree.h>

namespace strahl {
namespace {

using namespace test;

enum class Splitter { sweep, binned, cyclic, longest, morton };
constexpr Splitter kSplitters[] = {Splitter::sweep, Splitter::binned, Splitter::cyclic,
                                   Splitter::longest, Splitter::morton};
constexpr Splitter kSahSplitters[] = {Splitter::sweep, Splitter::binned};

std::unique_ptr<ObjectSplitter> make_splitter(Refs& refs, Splitter kind, const SahCost& cost) {
  if (kind == Splitter::sweep) return make_sweep_splitter(refs, cost);
  if (kind == Splitter::binned) return make_binned_splitter(refs, 32, cost);
  if (kind == Splitter::morton) return make_morton_splitter(refs, cost, {});
  const MedianAxis axis = kind == Splitter::cyclic ? MedianAxis::cyclic : MedianAxis::longest;
  return make_median_splitter(refs, axis, cost);
}

Tree build(Refs refs, Splitter kind, const LeafRules& rules, const BuildContext& context = {}) {
  const auto splitter = make_splitter(refs, kind, rules.cost);
  return build_object_tree(*splitter, refs.size(), box_of(refs), rules, context);
}

TEST(ObjectTree, HoldsItsInvariants) {
  const Refs refs = random_refs(3000, 1);
  for (const Splitter splitter : kSplitters)
    for (const std::size_t max_leaf : {1u, 4u, 100u}) {
      const Tree tree = build(refs, splitter, {kCost, max_leaf, 64});
      TreeCheck{tree, refs, max_leaf}.run();
    }
}

TEST(ObjectTree, LeavesSmallSetsUndividedAndOnlyThose) {
  const Refs refs = random_refs(3000, 1);
  for (const Splitter splitter : kSplitters) {
    const Tree tree = build(refs, splitter, {kCost, 1, 64, 3});
    TreeCheck{tree, refs, 3}.run();
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
      if (tree.nodes[i].is_leaf()) continue;
      const TreeNode &left = tree.nodes[i + 1], &right = tree.nodes[tree.nodes[i].right];
      if (left.is_leaf() && right.is_leaf()) {
        EXPECT_GT(left.count + right.count, 3u);
      }
    }
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
  const Refs refs = refs_of(boxes);
  EXPECT_GT(build(refs, Splitter::sweep, {kCost, 1, 64}).depth(), 6);
  for (int max_depth = 6; max_depth < 12; ++max_depth)
    EXPECT_LE(build(refs, Splitter::sweep, {kCost, 1, max_depth}).depth(), max_depth);
  EXPECT_EQ(build(refs, Splitter::sweep, {kCost, 1, 6}).depth(), 6);
}

TEST(ObjectTree, DividesNoSetThatIsCheaperAsALeaf) {
  const Refs refs = random_refs(100, 3);
  for (const Splitter splitter : kSahSplitters) {
    const SahCost dear{1e6, 1.0};
    EXPECT_EQ(build(refs, splitter, {dear, 100, 64}).nodes.size(), 1u);
    EXPECT_GT(build(refs, splitter, {dear, 99, 64}).nodes.size(), 1u);
    EXPECT_GT(build(refs, splitter, {{1e-6, 1.0}, 100, 64}).nodes.size(), 100u);
  }
}

TEST(ObjectTree, CostNeverPassesThatOfOneLeaf) {
  const Refs refs = random_refs(500, 4);
  for (const Splitter splitter : kSahSplitters) {
    const Tree tree = build(refs, splitter, {kCost, 500, 64});
    EXPECT_LT(tree.sah_cost(kCost), sah_leaf_cost(kCost, 500));
  }
}

TEST(ObjectTree, MedianCutHalvesDownToTheLeafSize) {
  for (const Splitter splitter : {Splitter::cyclic, Splitter::longest})
    for (const std::size_t count : {1u, 2u, 5u, 1000u, 1024u})
      for (const std::size_t max_leaf : {1u, 4u}) {
        const Tree tree = build(random_refs(count, 7), splitter, {kCost, max_leaf, 64});
        const std::size_t parts = (count + max_leaf - 1) / max_leaf;
        EXPECT_EQ(tree.depth(), static_cast<int>(std::bit_width(parts - 1)));
      }
}

TEST(ObjectTree, MedianCutTakesTheAxesInTurn) {
  const Tree tree = build(random_refs(64, 8), Splitter::cyclic, {kCost, 1, 64});
  std::vector<std::uint32_t> axis(tree.nodes.size(), 0);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    if (tree.nodes[i].is_leaf()) continue;
    EXPECT_EQ(tree.nodes[i].axis, axis[i]);
    axis[i + 1] = axis[tree.nodes[i].right] = (axis[i] + 1) % 3;
  }
}

TEST(ObjectTree, MedianCutPutsLowerCentresToTheLeft) {
  const Refs refs = random_refs(500, 9);
  const auto highest_and_lowest = [&](const Tree& tree, std::size_t from, std::size_t to,
                                      int axis) {
    double lo = Aabb::kInf, hi = -Aabb::kInf;
    for (std::size_t i = from; i < to; ++i) {
      if (!tree.nodes[i].is_leaf()) continue;
      const Aabb& box = refs[tree.references[tree.nodes[i].first]].box;
      const double center = box.lo[axis] + box.hi[axis];
      lo = std::min(lo, center), hi = std::max(hi, center);
    }
    return std::pair(lo, hi);
  };
  for (const Splitter splitter : {Splitter::cyclic, Splitter::longest}) {
    const Tree tree = build(refs, splitter, {kCost, 1, 64});
    const TreeNode& root = tree.nodes[0];
    const int axis = static_cast<int>(root.axis);
    EXPECT_LE(highest_and_lowest(tree, 1, root.right, axis).second,
              highest_and_lowest(tree, root.right, tree.nodes.size(), axis).first);
  }
}

/// The references of a radix tree over sorted codes, with a bracket around each pair.
void write_radix_tree(std::span<const MortonPlace> places, std::vector<std::uint32_t>& out) {
  constexpr std::uint32_t kOpen = ~0u, kClose = ~1u;
  if (places.size() == 1) return out.push_back(places[0].index);
  // The longest prefix that some neighbours have in common least: where it ends, sides part.
  std::size_t split = 0;
  int shortest = 64;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const int prefix = std::countl_zero(places[i].code ^ places[i + 1].code);
    if (prefix < shortest) shortest = prefix, split = i + 1;
  }
  if (shortest == 64) split = places.size() / 2;
  out.push_back(kOpen);
  write_radix_tree(places.first(split), out);
  write_radix_tree(places.subspan(split), out);
  out.push_back(kClose);
}

void write_tree(const Tree& tree, std::size_t node, std::vector<std::uint32_t>& out) {
  if (tree.nodes[node].is_leaf()) return out.push_back(tree.references[tree.nodes[node].first]);
  out.push_back(~0u);
  write_tree(tree, node + 1, out);
  write_tree(tree, tree.nodes[node].right, out);
  out.push_back(~1u);
}

TEST(ObjectTree, OfMortonCodesIsTheirRadixTree) {
  Refs refs = random_refs(500, 10);
  for (std::size_t i = 0; i < 40; ++i) refs[i].box = refs[7].box;  // equal codes
  for (std::size_t i = 40; i < 80; ++i) {  // codes that differ in the last bits only
    const auto steps = [](std::size_t n) { return 3e-7 * static_cast<double>(n); };
    const Vec3d by{steps(i % 2), steps(i / 2 % 3), steps(i / 6 % 4)};
    refs[i].box = {refs[40].box.lo + by, refs[40].box.hi + by};
  }
  std::vector<std::uint32_t> expected, got;
  write_radix_tree(morton_order(refs, {}), expected);
  write_tree(build(refs, Splitter::morton, {kCost, 1, 64}), 0, got);
  EXPECT_EQ(got, expected);
}

TEST(ObjectTree, OfTheSceneGraphHasEveryGroupAsANode) {
  const Refs refs = random_refs(300, 11);
  std::vector<ScenePart> parts;  // instances of 100, 1, 99 and 100 primitives, geometries of 10
  for (std::uint32_t i = 0; i < 300; ++i)
    parts.push_back({i < 100 ? 0u : i == 100 ? 1u : i < 200 ? 2u : 3u, i / 10});
  const auto splitter = make_scene_graph_splitter(refs, parts, kCost);
  const Tree tree = build_object_tree(*splitter, 300, box_of(refs), {kCost, 4, 64}, {});
  TreeCheck{tree, refs, 4}.run();
  for (std::uint32_t i = 0; i < 300; ++i) EXPECT_EQ(tree.references[i], i);  // file order
  std::set<std::pair<std::uint32_t, std::uint32_t>> runs;  // of references, first and end
  std::vector<std::pair<std::uint32_t, std::uint32_t>> below(tree.nodes.size());
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    const TreeNode& node = tree.nodes[i];
    below[i] = node.is_leaf() ? std::pair(node.first, node.first + node.count)
                              : std::pair(below[i + 1].first, below[node.right].second);
    runs.insert(below[i]);
  }
  for (const auto& group : {std::pair(0u, 100u),
                            {100u, 101u},
                            {101u, 200u},
                            {200u, 300u},
                            {10u, 20u},
                            {101u, 110u},
                            {290u, 300u}})
    EXPECT_TRUE(runs.count(group)) << group.first;
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
