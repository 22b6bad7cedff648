// Loops over hand-made trees: which nodes each order opens.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/query/counters.h>
#include <strahl/traverse/best_first.h>

namespace strahl {
namespace {

/// A tree whose nodes say where the ray enters them; leaf i refers to thing i, which is hit at
/// hit[i].
struct TimeTree {
  static constexpr int kMaxChildren = 16, kMaxDepth = 64;
  struct Node {
    double t_enter;
    std::vector<std::uint32_t> children;
    std::vector<std::uint32_t> own;
  };
  std::vector<Node> nodes;
  bool sorts = false;

  NodeVisit enter(const PreparedRay&) const { return {0, {nodes[0].t_enter, Aabb::kInf}}; }
  bool is_leaf(std::uint32_t i) const { return nodes[i].children.empty(); }
  std::span<const std::uint32_t> references(std::uint32_t i) const { return nodes[i].own; }
  template <class C>
  int expand(const PreparedRay&, const NodeVisit& at, NodeVisit* child, C&) const {
    int count = 0;
    for (const std::uint32_t i : nodes[at.node].children)
      child[count++] = {i, {std::max(at.span.t_enter, nodes[i].t_enter), Aabb::kInf}};
    if (sorts)
      std::stable_sort(child, child + count, [](const NodeVisit& a, const NodeVisit& b) {
        return a.span.t_enter < b.span.t_enter;
      });
    return count;
  }
};

struct Nearest {
  double best = Aabb::kInf;
  std::uint32_t thing = ~0u;
  double t_max() const { return best; }
};

/// Ties go to the lowest number, as everywhere.
struct Things {
  std::vector<double> hit;
  std::vector<std::uint32_t> tested;

  template <class C>
  bool visit(std::uint32_t i, const PreparedRay&, Nearest& query, C&) {
    tested.push_back(i);
    if (hit[i] < query.best || (hit[i] == query.best && i < query.thing))
      query.best = hit[i], query.thing = i;
    return false;
  }
};

struct Outcome {
  Nearest nearest;
  std::vector<std::uint32_t> tested;
  Counters counters;
};

Outcome best_first(const TimeTree& tree, Things things) {
  Outcome out;
  walk_best_first(tree, things, PreparedRay(), out.nearest, out.counters);
  out.tested = things.tested;
  return out;
}

Outcome depth_first(TimeTree tree, Things things, bool sorts) {
  Outcome out;
  tree.sorts = sorts;
  walk(tree, things, PreparedRay(), out.nearest, out.counters);
  out.tested = things.tested;
  return out;
}

/// The lecture's example: root 13 of 9 and 10; 9 of things 1 to 3; 10 of 11 and 12; 11 of 6 to 8;
/// 12 of 4 and 5.
TimeTree lecture_tree(double at9, double at10, double at11, double at12) {
  TimeTree tree;
  tree.nodes = {{1, {1, 2}, {}},
                {at9, {}, {1, 2, 3}},
                {at10, {3, 4}, {}},
                {at11, {}, {6, 7, 8}},
                {at12, {}, {4, 5}}};
  return tree;
}

TEST(BestFirst, GoesOnWithTheNearestOfAllAsInTheLecture) {
  // 12 is entered before 11 and before 9; thing 5 is hit before either begins.
  Things things;
  things.hit = {Aabb::kInf, Aabb::kInf, Aabb::kInf, 9, Aabb::kInf, 4, Aabb::kInf, 7, Aabb::kInf};
  const TimeTree tree = lecture_tree(5, 2, 6, 3);
  const Outcome heap = best_first(tree, things);
  EXPECT_EQ(heap.nearest.thing, 5u);
  EXPECT_EQ(heap.tested, (std::vector<std::uint32_t>{4, 5}));
  EXPECT_EQ(heap.counters.traversal_steps, 2u);
  EXPECT_EQ(heap.counters.leaves, 1u);
  EXPECT_EQ(heap.counters.most_waiting, 3u);  // 9, 11 and 12
  const Outcome plain = depth_first(tree, things, false);
  EXPECT_EQ(plain.nearest.thing, 5u);
  EXPECT_EQ(plain.tested, (std::vector<std::uint32_t>{1, 2, 3, 6, 7, 8, 4, 5}));
}

TEST(BestFirst, AHitInANearSubtreeDoesNotHideANearerOneInAFartherSubtree) {
  // Thing 5 of the nearer node 12 is hit behind the entry of 11, where thing 7 lies before it.
  Things things;
  things.hit = {0, 9, 9, 9, 9, 8, 9, 7, 9};
  const Outcome heap = best_first(lecture_tree(20, 2, 6, 3), things);
  EXPECT_EQ(heap.nearest.thing, 7u);
  EXPECT_EQ(heap.counters.leaves, 2u);
}

TEST(BestFirst, ATieAtTheEntryOfALaterSubtreeIsNotLost) {
  Things things;
  things.hit = {0, 9, 9, 9, 9, 4, 9, 9, 9};
  things.hit[1] = 4;
  // 9 is entered a little behind the hit, by less than the margin: thing 1 wins the tie.
  EXPECT_EQ(best_first(lecture_tree(4 * (1 + 0x1p-41), 2, 6, 3), things).nearest.thing, 1u);
  EXPECT_EQ(best_first(lecture_tree(4, 2, 6, 3), things).nearest.thing, 1u);
}

TEST(BestFirst, HoldsMoreThanFitsItsOwnMemory) {
  TimeTree tree;
  Things things;
  tree.nodes.push_back({0, {}, {}});
  Rng rng(1);
  std::vector<std::uint32_t> level{0};
  for (int depth = 0; depth < 3; ++depth) {
    std::vector<std::uint32_t> next;
    for (const std::uint32_t parent : level)
      for (int k = 0; k < 16; ++k) {
        const auto child = static_cast<std::uint32_t>(tree.nodes.size());
        tree.nodes[parent].children.push_back(child), next.push_back(child);
        tree.nodes.push_back({depth < 2 ? 0.0 : rng.uniform(1, 2), {}, {}});
      }
    level = next;
  }
  for (const std::uint32_t leaf : level) {
    tree.nodes[leaf].own = {static_cast<std::uint32_t>(things.hit.size())};
    things.hit.push_back(Aabb::kInf);
  }
  const Outcome heap = best_first(tree, things);
  EXPECT_GT(heap.counters.most_waiting, 10 * VisitHeap::kOwn);
  EXPECT_EQ(heap.counters.leaves, 4096u);
  for (std::size_t i = 1; i < heap.tested.size(); ++i)  // thing i is in leaf level[i]
    ASSERT_LE(tree.nodes[level[heap.tested[i - 1]]].t_enter,
              tree.nodes[level[heap.tested[i]]].t_enter);
}

/// A random tree in which hits lie at or behind the entries of their leaves, many in ties.
void random_case(Rng& rng, TimeTree& tree, Things& things) {
  tree.nodes.push_back({0.0, {}, {}});
  for (std::size_t i = 0; i < tree.nodes.size() && tree.nodes.size() < 120; ++i) {
    const std::uint32_t children = i > 0 && rng.below(3) == 0 ? 0 : 2 + rng.below(4);
    for (std::uint32_t k = 0; k < children; ++k) {
      tree.nodes[i].children.push_back(static_cast<std::uint32_t>(tree.nodes.size()));
      const double enter = std::max(tree.nodes[i].t_enter, static_cast<double>(rng.below(12)));
      tree.nodes.push_back({enter, {}, {}});
    }
  }
  for (TimeTree::Node& node : tree.nodes) {
    if (!node.children.empty()) continue;
    node.own = {static_cast<std::uint32_t>(things.hit.size())};
    things.hit.push_back(rng.below(3) == 0 ? node.t_enter + rng.below(4) : Aabb::kInf);
  }
}

TEST(BestFirst, NeverOpensMoreThanOtherOrdersAndFindsTheSame) {
  Rng rng(2);
  int fewer = 0;
  for (int run = 0; run < 2000; ++run) {
    TimeTree tree;
    Things things;
    random_case(rng, tree, things);
    const Outcome heap = best_first(tree, things);
    for (const bool sorts : {false, true}) {
      const Outcome other = depth_first(tree, things, sorts);
      ASSERT_EQ(heap.nearest.thing, other.nearest.thing);
      ASSERT_LE(heap.counters.traversal_steps, other.counters.traversal_steps);
      ASSERT_LE(heap.counters.leaves, other.counters.leaves);
      fewer += heap.counters.traversal_steps < other.counters.traversal_steps;
    }
  }
  EXPECT_GT(fewer, 500);
}

}  // namespace
}  // namespace strahl
