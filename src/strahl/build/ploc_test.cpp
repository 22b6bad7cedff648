#include <tests/support/tree_cases.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/build/morton_order.h>
#include <strahl/build/object_tree.h>
#include <strahl/build/ploc.h>

namespace strahl {
namespace {

using namespace test;

TEST(Ploc, HoldsEveryPrimitive) {
  for (const std::size_t count : {1u, 2u, 3u, 1000u})
    for (const int radius : {1, 8, 256}) {
      const Refs refs = random_refs(count, count);
      const Tree tree = make_tree(build_ploc_tree(refs, radius, {}));
      EXPECT_EQ(tree.nodes.size(), 2 * count - 1);
      TreeCheck{tree, refs, 1}.run();
    }
}

/// One round after the other, over clusters as a list of boxes; no two areas are equal.
std::vector<Aabb> rounds_by_definition(const Refs& refs, std::size_t radius) {
  std::vector<Aabb> active, made;
  for (const MortonPlace& place : morton_order(refs, {})) active.push_back(refs[place.index].box);
  while (active.size() > 1) {
    const auto nearest = [&](std::size_t i) {
      std::size_t best = i;
      double least = Aabb::kInf;
      for (std::size_t j = 0; j < active.size(); ++j) {
        if (j == i || j + radius < i || j > i + radius) continue;
        const double area = Aabb::join(active[i], active[j]).half_area();
        if (area < least) least = area, best = j;
      }
      return best;
    };
    std::vector<Aabb> next;
    for (std::size_t i = 0; i < active.size(); ++i) {
      const std::size_t j = nearest(i);
      if (nearest(j) != i) {
        next.push_back(active[i]);
      } else if (i < j) {
        next.push_back(Aabb::join(active[i], active[j]));
        made.push_back(next.back());
      }
    }
    active = next;
  }
  return made;
}

TEST(Ploc, JoinsMutualNeighboursRoundByRound) {
  const Refs refs = random_refs(400, 1);
  for (const std::size_t radius : {2u, 10u, 400u}) {
    const LinkedTree tree = build_ploc_tree(refs, static_cast<int>(radius), {});
    std::vector<Aabb> made;
    for (std::size_t i = refs.size(); i < tree.nodes.size(); ++i) made.push_back(tree.nodes[i].box);
    EXPECT_EQ(made, rounds_by_definition(refs, radius));
  }
}

TEST(Ploc, ComesToAnEndOnDegenerateInput) {
  std::vector<Input> all = degenerate_inputs();
  std::vector<Aabb> growing;  // each nearer to the next one than to the last
  for (int i = 0; i < 20000; ++i) growing.push_back(cube({1e6 - 50.0 * i + 1e-3 * i * i, 0, 0}, 0));
  all.push_back({"growing", refs_of(growing)});
  for (const Input& input : all) {
    SCOPED_TRACE(input.name);
    const Tree tree = limit_depth(make_tree(build_ploc_tree(input.refs, 8, {})), 64, kCost, {});
    EXPECT_LE(tree.depth(), 64);
    TreeCheck{tree, input.refs, 1}.run();
  }
}

TEST(Ploc, PairsEqualBoxesEvenly) {
  const Refs refs = degenerate_inputs()[0].refs;
  EXPECT_LE(make_tree(build_ploc_tree(refs, 8, {})).depth(), 16);
}

TEST(Ploc, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  BuildContext two;
  two.executor = Executor::with_threads(2);
  const Refs refs = random_refs(100000, 2);
  expect_equal(make_tree(build_ploc_tree(refs, 4, {})), make_tree(build_ploc_tree(refs, 4, two)));
}

TEST(Ploc, IsCheaperThanTheCurveAlone) {
  const Refs refs = random_refs(20000, 3);
  const auto curve = make_morton_splitter(refs, kCost, {});
  const Tree lbvh = build_object_tree(*curve, refs.size(), box_of(refs), {kCost, 1, 64}, {});
  EXPECT_LT(make_tree(build_ploc_tree(refs, 16, {})).sah_cost(kCost), lbvh.sah_cost(kCost));
}

TEST(Ploc, CanBeCancelled) {
  BuildContext context;
  context.progress = [&](double fraction, std::string_view) { return fraction < 0.5; };
  EXPECT_THROW(build_ploc_tree(random_refs(1000, 4), 4, context), Error);
}

}  // namespace
}  // namespace strahl
