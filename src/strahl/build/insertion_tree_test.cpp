#include <algorithm>
#include <bit>
#include <functional>
#include <set>
#include <tests/support/bundles.h>
#include <tests/support/hierarchy_check.h>
#include <tests/support/tree_cases.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/build/insertion_tree.h>

namespace strahl {
namespace {

using namespace test;

constexpr InsertSearch kSearches[] = {InsertSearch::growth, InsertSearch::local,
                                      InsertSearch::branch_and_bound};
constexpr InsertOrder kOrders[] = {InsertOrder::file, InsertOrder::sorted, InsertOrder::shuffled};

/// Single primitives in the leaves.
InsertionRules with(InsertSearch search, InsertOrder order = InsertOrder::file) {
  InsertionRules rules;
  rules.search = search, rules.order = order, rules.max_leaf = 1;
  return rules;
}

/// Unit squares of a plane.
Refs tiles(const std::vector<std::pair<int, int>>& places) {
  std::vector<Aabb> boxes;
  for (const auto& [x, y] : places) {
    const Vec3d at{static_cast<double>(x), static_cast<double>(y), 0.0};
    boxes.push_back({at, at + Vec3d{1, 1, 0}});
  }
  return refs_of(boxes);
}

/// The references below each child of the root.
std::set<std::vector<std::uint32_t>> groups(const Hierarchy& tree) {
  std::set<std::vector<std::uint32_t>> all;
  for (const HierarchyNode& child : tree.children(tree.nodes[0])) {
    std::vector<std::uint32_t> below;
    const std::function<void(const HierarchyNode&)> list = [&](const HierarchyNode& node) {
      for (std::uint32_t i = 0; i < node.count; ++i)
        below.push_back(tree.references[node.first + i]);
      for (const HierarchyNode& c : tree.children(node)) list(c);
    };
    list(child);
    std::sort(below.begin(), below.end());
    all.insert(below);
  }
  return all;
}

TEST(InsertionTree, FollowsTheWorkedExample) {
  // Rows of tiles: 1 3 / 4 / 2, inserted as numbered.
  const Refs refs = tiles({{0, 2}, {0, 0}, {1, 2}, {0, 1}});
  for (const InsertSearch search : kSearches) {
    const Hierarchy tree = build_insertion_tree(refs, with(search), {});
    EXPECT_EQ(groups(tree), (std::set<std::vector<std::uint32_t>>{{0, 2}, {1, 3}}));
    // 2 * 6 for the root, 2 * 2 for each pair.
    EXPECT_DOUBLE_EQ(insertion_cost(tree), 1.0 + (12.0 + 4.0 + 4.0) / 6.0);
  }
}

TEST(InsertionTree, HoldsItsInvariants) {
  const Refs refs = random_refs(2000, 1);
  for (const InsertSearch search : kSearches)
    for (const InsertOrder order : kOrders)
      for (const std::uint32_t most : {2u, 3u, 16u})
        for (const std::size_t max_leaf : {1u, 5u}) {
          InsertionRules rules = with(search, order);
          rules.max_children = most, rules.max_leaf = max_leaf;
          check_hierarchy(build_insertion_tree(refs, rules, {}), refs, max_leaf,
                          static_cast<int>(most));
        }
}

TEST(InsertionTree, IsALeafForASinglePrimitive) {
  const Hierarchy tree = build_insertion_tree(random_refs(1, 2), with(InsertSearch::local), {});
  ASSERT_EQ(tree.nodes.size(), 1u);
  EXPECT_EQ(tree.nodes[0].count, 1u);
  EXPECT_EQ(insertion_cost(tree), 1.0);
}

/// The least a tree can cost after one more box, by trying every place and adding up all nodes.
double least_cost_after(const Hierarchy& tree, const Aabb& box, std::uint32_t max_children) {
  std::vector<std::size_t> parent(tree.nodes.size(), ~std::size_t{0});
  for (std::size_t i = 0; i < tree.nodes.size(); ++i)
    for (std::uint32_t c = 0; c < tree.nodes[i].children; ++c) parent[tree.nodes[i].first + c] = i;
  const auto cost_with = [&](std::size_t place, bool below) {
    std::vector<bool> grows(tree.nodes.size(), false);
    for (std::size_t up = below ? place : parent[place]; up != ~std::size_t{0}; up = parent[up])
      grows[up] = true;
    double sum = below ? 0.0 : 2.0 * Aabb::join(tree.nodes[place].box, box).half_area();
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
      const HierarchyNode& node = tree.nodes[i];
      const Aabb own = grows[i] ? Aabb::join(node.box, box) : node.box;
      sum += own.half_area() * (node.children + (below && i == place ? 1.0 : 0.0));
    }
    return sum;
  };
  double least = Aabb::kInf;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    least = std::min(least, cost_with(i, false));
    const std::uint32_t children = tree.nodes[i].children;
    if (children > 0 && children < max_children) least = std::min(least, cost_with(i, true));
  }
  return least;
}

TEST(InsertionTree, BranchAndBoundFindsTheCheapestPlace) {
  for (const std::uint32_t most : {2u, 4u, 16u}) {
    Refs refs = random_refs(120, 3);
    for (std::size_t i = 0; i < refs.size(); i += 3)  // some are as large as what they lie in
      refs[i].box.hi = refs[i].box.lo + Vec3d::all(0.1 + 0.004 * static_cast<double>(i));
    InsertionRules rules = with(InsertSearch::branch_and_bound);
    rules.max_children = most;
    for (std::size_t n = 1; n < refs.size(); ++n) {
      const Hierarchy before = build_insertion_tree(std::span(refs).first(n), rules, {});
      const Hierarchy after = build_insertion_tree(std::span(refs).first(n + 1), rules, {});
      const double cost = (insertion_cost(after) - 1.0) * after.nodes[0].box.half_area();
      const double least = least_cost_after(before, refs[n].box, most);
      EXPECT_NEAR(cost, least, 1e-12 * least) << n;
    }
  }
}

TEST(InsertionTree, BranchAndBoundFindsNodesHardlyLargerThanTheBox) {
  // The cheapest place is below a node of hardly the box's own area, and none above tells which.
  const Refs refs = bundled_refs(150, 12, 8);
  const InsertionRules rules = with(InsertSearch::branch_and_bound);
  for (std::size_t n = 1; n < refs.size(); ++n) {
    const Hierarchy before = build_insertion_tree(std::span(refs).first(n), rules, {});
    const Hierarchy after = build_insertion_tree(std::span(refs).first(n + 1), rules, {});
    const double cost = (insertion_cost(after) - 1.0) * after.nodes[0].box.half_area();
    const double least = least_cost_after(before, refs[n].box, rules.max_children);
    EXPECT_NEAR(cost, least, 1e-12 * least) << n;
  }
}

TEST(InsertionTree, ChildrenWithoutGrowthAreTakenByGrowthEvenWhereThatIsDear) {
  // Half of the root without growth against a small box that triples: Haines' counter-example.
  const Refs refs = refs_of({{{0, 0, 0}, {5, 10, 10}},
                             {{9, 0, 0}, {10, 1, 1}},
                             {{5.5, 9, 9}, {6, 10, 10}},
                             {{4, 0, 0}, {4.1, 1, 1}}});
  const double by_growth =
      insertion_cost(build_insertion_tree(refs, with(InsertSearch::growth), {}));
  const double by_cost =
      insertion_cost(build_insertion_tree(refs, with(InsertSearch::branch_and_bound), {}));
  EXPECT_LE(by_cost, by_growth);
}

TEST(InsertionTree, AttachesWhereEveryChildWouldBecomeAsLargeAsTheNode) {
  // Two long plates and a third between them: each pair spans nine tenths of all.
  const Refs refs =
      refs_of({{{0, 0, 0}, {10, 10, 0}}, {{0, 0, 1}, {10, 10, 1}}, {{0, 0, 0.5}, {10, 10, 0.5}}});
  InsertionRules rules = with(InsertSearch::growth);
  rules.attach_share = 0.8;
  EXPECT_EQ(build_insertion_tree(refs, rules, {}).nodes[0].children, 3u);
  rules.max_children = 2;
  EXPECT_EQ(build_insertion_tree(refs, rules, {}).nodes[0].children, 2u);
}

TEST(InsertionTree, AttachesEverythingToTheRootWhereAnyShareIsTooLarge) {
  const Refs refs = random_refs(12, 7);
  for (const InsertSearch search : {InsertSearch::growth, InsertSearch::local}) {
    InsertionRules rules = with(search);
    EXPECT_LT(build_insertion_tree(refs, rules, {}).nodes[0].children, 12u);
    rules.attach_share = 0.0;
    EXPECT_EQ(build_insertion_tree(refs, rules, {}).nodes[0].children, 12u);
  }
}

TEST(InsertionTree, ShufflesBySeed) {
  const Refs refs = random_refs(500, 4);
  InsertionRules rules = with(InsertSearch::local, InsertOrder::shuffled);
  const double first = insertion_cost(build_insertion_tree(refs, rules, {}));
  EXPECT_EQ(insertion_cost(build_insertion_tree(refs, rules, {})), first);
  rules.seed = 1;
  EXPECT_NE(insertion_cost(build_insertion_tree(refs, rules, {})), first);
}

TEST(InsertionTree, SortsByCentres) {
  Refs refs = tiles({{4, 0}, {1, 0}, {3, 0}, {0, 0}, {2, 0}});
  InsertionRules rules = with(InsertSearch::local, InsertOrder::sorted);
  const double sorted = insertion_cost(build_insertion_tree(refs, rules, {}));
  refs = tiles({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}});
  EXPECT_EQ(insertion_cost(build_insertion_tree(refs, with(InsertSearch::local), {})), sorted);
}

TEST(InsertionTree, StopsWithinTheDepthBoundOnDegenerateInput) {
  for (const Input& input : degenerate_inputs())
    for (const InsertSearch search : kSearches)
      for (const std::uint32_t most : {2u, 16u}) {
        SCOPED_TRACE(input.name);
        // Where nothing tells places apart, branch and bound looks at very many.
        const bool is_slow = search == InsertSearch::branch_and_bound;
        const Refs refs(input.refs.begin(), input.refs.begin() + (is_slow ? 500 : 5000));
        InsertionRules rules = with(search);
        rules.max_children = most, rules.max_depth = 22;
        const Hierarchy tree = build_insertion_tree(refs, rules, {});
        EXPECT_LE(tree.depth(), rules.max_depth);
        check_hierarchy(tree, refs, 1, static_cast<int>(most));
      }
}

TEST(InsertionTree, HasLeavesOnlyWhereTheyAreNotDearer) {
  const Refs refs = random_refs(1000, 5);
  InsertionRules rules = with(InsertSearch::local);
  const double single = build_insertion_tree(refs, rules, {}).sah_cost(rules.cost);
  rules.max_leaf = 8;
  const Hierarchy tree = build_insertion_tree(refs, rules, {});
  EXPECT_LT(tree.sah_cost(rules.cost), single);
  EXPECT_LT(tree.nodes.size(), 1900u);
}

TEST(InsertionTree, CanBeCancelledAndKeepsToTheMemoryLimit) {
  const Refs refs = random_refs(20000, 6);
  BuildContext context;
  double last = 0.0;
  context.progress = [&](double fraction, std::string_view) { return (last = fraction) < 0.5; };
  EXPECT_THROW(build_insertion_tree(refs, with(InsertSearch::growth), context), Error);
  EXPECT_NEAR(last, 0.5, 0.1);
  BuildContext small;
  small.memory_limit = 1'000'000;
  EXPECT_THROW(build_insertion_tree(refs, with(InsertSearch::growth), small), Error);
}

}  // namespace
}  // namespace strahl
