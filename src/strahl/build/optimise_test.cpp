#include <algorithm>
#include <tests/support/bundles.h>
#include <tests/support/tree_areas.h>
#include <tests/support/tree_cases.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/build/object_tree.h>
#include <strahl/build/optimise.h>

namespace strahl {
namespace {

using namespace test;

enum class By { rotations, reinsertion };
constexpr By kBoth[] = {By::rotations, By::reinsertion};

void optimise(LinkedTree& tree, By by, const BuildContext& context = {}) {
  if (by == By::rotations) return rotate_tree(tree, context);
  reinsert_nodes(tree, {}, context);
}

LinkedTree median_tree(Refs refs) {
  const auto splitter = make_median_splitter(refs, MedianAxis::longest, kCost);
  return make_linked(build_object_tree(*splitter, refs.size(), box_of(refs), {kCost, 1, 64}, {}));
}

double sweep_area(Refs refs) {
  const auto splitter = make_sweep_splitter(refs, kCost);
  return make_linked(build_object_tree(*splitter, refs.size(), box_of(refs), {kCost, 1, 64}, {}))
      .inner_area();
}

/// ((0, 2), (1, 3)) where 0, 1 and 2, 3 are together.
LinkedTree crossed_pairs(const Refs& refs) {
  LinkedTree tree = LinkedTree::of_leaves(refs);
  const std::uint32_t first = tree.join(0, 2), second = tree.join(1, 3);
  tree.join(first, second);
  return tree;
}

TEST(Optimise, UncrossesPairs) {
  const Refs refs =
      refs_of({cube({0, 0, 0}, 1), cube({1, 0, 0}, 1), cube({9, 0, 0}, 1), cube({10, 0, 0}, 1)});
  for (const By by : kBoth) {
    LinkedTree tree = crossed_pairs(refs);
    optimise(tree, by);
    EXPECT_EQ(tree.nodes[0].parent, tree.nodes[1].parent);
    EXPECT_EQ(tree.nodes[2].parent, tree.nodes[3].parent);
    // Half areas: 2 x 1 x 1 boxes have 5, the root of 11 x 1 x 1 has 23.
    EXPECT_EQ(tree.inner_area(), 33.0);
  }
}

TEST(Optimise, ReinsertionBringsAStrayBoxHomeFromAnyDepth) {
  for (const std::uint32_t stray : {0u, 100u, 399u}) {
    Refs refs = random_refs(400, 1);
    for (std::size_t i = 0; i < 400; ++i)
      if (i % 2 == 1)
        refs[i].box = {refs[i].box.lo + Vec3d::all(100), refs[i].box.hi + Vec3d::all(100)};
    const double good = sweep_area(refs);
    LinkedTree tree = median_tree(refs);
    std::uint32_t leaf = 0;
    while (!tree.nodes[leaf].is_leaf() || tree.nodes[leaf].right != stray) ++leaf;
    // To the other side: across everything in between.
    const Vec3d away = Vec3d::all(stray % 2 == 1 ? -100 : 100);
    tree.nodes[leaf].box = {tree.nodes[leaf].box.lo + away, tree.nodes[leaf].box.hi + away};
    tree.refit_from(tree.nodes[leaf].parent);
    refs[stray].box = tree.nodes[leaf].box;
    EXPECT_GT(tree.inner_area(), 1.5 * good);
    optimise(tree, By::reinsertion);
    EXPECT_LT(tree.inner_area(), 1.05 * good);
    TreeCheck{make_tree(tree), refs, 1}.run();
  }
}

bool is_above(const LinkedTree& tree, std::uint32_t ancestor, std::uint32_t node) {
  while (node != LinkedNode::kNone && node != ancestor) node = tree.nodes[node].parent;
  return node == ancestor;
}

/// The least the sum can become by taking one node out and putting it anywhere but beside what is
/// above it, where reinsertion does not look.
double least_after_one_move(const LinkedTree& tree) {
  double least = tree.inner_area();
  for (std::uint32_t node = 0; node < tree.nodes.size(); ++node)
    for (std::uint32_t target = 0; target < tree.nodes.size(); ++target) {
      if (node == tree.root || is_above(tree, node, target) || is_above(tree, target, node))
        continue;
      LinkedTree moved = tree;
      const std::uint32_t parent = moved.nodes[node].parent;
      const std::uint32_t above = moved.nodes[parent].parent;
      moved.replace_child(parent, moved.nodes[parent].sibling_of(node));
      moved.refit_from(above);
      moved.replace_child(target, parent);
      moved.nodes[parent].left = target, moved.nodes[parent].right = node;
      moved.nodes[target].parent = parent;
      moved.nodes[parent].box = Aabb::join(moved.nodes[target].box, moved.nodes[node].box);
      moved.refit_from(moved.nodes[parent].parent);
      least = std::min(least, moved.inner_area());
    }
  return least;
}

TEST(Optimise, ReinsertionEndsWhereNoMoveHelps) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    LinkedTree tree =
        median_tree(seed % 2 == 0 ? random_refs(30, seed) : bundled_refs(30, 6, seed));
    reinsert_nodes(tree, {100, 0.0}, {});
    EXPECT_GE(least_after_one_move(tree), (1.0 - 1e-12) * tree.inner_area());
  }
}

TEST(Optimise, LeavesAloneWhatIsBestAlready) {
  // Three cubes in a row, the last one a little farther away: other pairs lose next to nothing.
  for (const double loss : {1e-9, 1e-3, 4e-3}) {
    const Refs refs =
        refs_of({cube({0, 0, 0}, 1), cube({1, 0, 0}, 1), cube({2.0 + loss, 0, 0}, 1)});
    LinkedTree tree = LinkedTree::of_leaves(refs);
    tree.join(tree.join(0, 1), 2);
    const std::vector<double> before = areas_of(tree);
    for (const By by : kBoth) {
      optimise(tree, by);
      EXPECT_EQ(areas_of(tree), before) << loss;
      EXPECT_EQ(tree.nodes[0].parent, tree.nodes[1].parent);
    }
  }
}

/// Whether exchanging two subtrees, of which neither is above the other, lowers the sum.
bool helps_to_exchange(LinkedTree tree, std::uint32_t a, std::uint32_t b) {
  const double before = tree.inner_area();
  const std::uint32_t above_a = tree.nodes[a].parent, above_b = tree.nodes[b].parent;
  tree.replace_child(a, b);  // names above_a as b's parent
  (tree.nodes[above_b].left == b ? tree.nodes[above_b].left : tree.nodes[above_b].right) = a;
  tree.nodes[a].parent = above_b;
  tree.refit_from(above_a), tree.refit_from(above_b);
  return tree.inner_area() < (1.0 - 1e-12) * before;
}

TEST(Optimise, RotationsEndWhereNoneHelps) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    LinkedTree tree = median_tree(random_refs(40, seed));
    double before = 0.0;
    do {
      before = tree.inner_area();
      rotate_tree(tree, {});
    } while (tree.inner_area() < before);
    for (std::uint32_t node = 0; node < tree.nodes.size(); ++node) {
      const std::uint32_t parent = tree.nodes[node].parent;
      if (node == tree.root || parent == tree.root) continue;
      // With its parent's sibling, and with the children of that.
      const std::uint32_t beside = tree.nodes[tree.nodes[parent].parent].sibling_of(parent);
      EXPECT_FALSE(helps_to_exchange(tree, node, beside)) << seed;
      if (tree.nodes[beside].is_leaf()) continue;
      EXPECT_FALSE(helps_to_exchange(tree, node, tree.nodes[beside].left)) << seed;
      EXPECT_FALSE(helps_to_exchange(tree, node, tree.nodes[beside].right)) << seed;
    }
  }
}

TEST(Optimise, NeverRaisesTheCostAndKeepsTheLeaves) {
  std::vector<Input> all = degenerate_inputs();
  for (Input& input : all) input.refs.resize(1000);
  all.push_back({"random", random_refs(2000, 2)});
  for (const Input& input : all)
    for (const By by : kBoth) {
      SCOPED_TRACE(input.name);
      LinkedTree tree = median_tree(input.refs);
      const double before = tree.inner_area();
      optimise(tree, by);
      const double after = tree.inner_area();
      EXPECT_LE(after, before * (1.0 + 1e-12));
      optimise(tree, by);
      EXPECT_LE(tree.inner_area(), after * (1.0 + 1e-12));
      TreeCheck{limit_depth(make_tree(tree), 64, kCost, {}), input.refs, 1}.run();
    }
}

TEST(Optimise, ReinsertionMakesMedianCutAsGoodAsSweep) {
  const Refs refs = random_refs(5000, 3);
  LinkedTree tree = median_tree(refs);
  EXPECT_GT(tree.inner_area(), 1.1 * sweep_area(refs));
  optimise(tree, By::reinsertion);
  EXPECT_LT(tree.inner_area(), sweep_area(refs));
}

TEST(Optimise, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  BuildContext two;
  two.executor = Executor::with_threads(2);
  for (const By by : kBoth) {
    LinkedTree serial = median_tree(random_refs(5000, 4)), parallel = serial;
    optimise(serial, by);
    optimise(parallel, by, two);
    expect_equal(make_tree(serial), make_tree(parallel));
  }
}

TEST(Optimise, CanBeCancelled) {
  BuildContext context;
  int calls = 0;
  context.progress = [&](double, std::string_view) { return ++calls < 2; };
  for (const By by : kBoth) {
    calls = 0;
    LinkedTree tree = median_tree(random_refs(2000, 5));
    EXPECT_THROW(optimise(tree, by, context), Error);
  }
}

}  // namespace
}  // namespace strahl
