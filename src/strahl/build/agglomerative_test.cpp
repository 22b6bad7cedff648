#include <algorithm>
#include <tests/support/bundles.h>
#include <tests/support/tree_areas.h>
#include <tests/support/tree_cases.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/build/agglomerative.h>

namespace strahl {
namespace {

using namespace test;

TEST(Agglomerative, HoldsEveryPrimitive) {
  for (const std::size_t count : {1u, 2u, 3u, 9u, 2000u}) {
    const Refs refs = random_refs(count, count);
    const Tree tree = make_tree(build_agglomerative_tree(refs, {}));
    EXPECT_EQ(tree.nodes.size(), 2 * count - 1);
    TreeCheck{tree, refs, 1}.run();
  }
}

/// Areas of what is joined when all pairs are compared each time, ascending.
std::vector<double> greedy_areas(const Refs& refs) {
  std::vector<Aabb> active;
  for (const PrimRef& ref : refs) active.push_back(ref.box);
  std::vector<double> areas;
  while (active.size() > 1) {
    std::size_t a = 0, b = 1;
    double least = Aabb::kInf;
    for (std::size_t i = 0; i < active.size(); ++i)
      for (std::size_t j = i + 1; j < active.size(); ++j) {
        const double area = Aabb::join(active[i], active[j]).half_area();
        if (area < least) least = area, a = i, b = j;
      }
    areas.push_back(least);
    active[a].extend(active[b]);
    active.erase(active.begin() + static_cast<std::ptrdiff_t>(b));
  }
  std::sort(areas.begin(), areas.end());
  return areas;
}

TEST(Agglomerative, IsTheGreedyTree) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Refs refs = random_refs(seed < 4 ? 50 : 200, seed);
    EXPECT_EQ(areas_of(build_agglomerative_tree(refs, {})), greedy_areas(refs));
  }
  // Where bounds hardly tell boxes apart.
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Refs refs = bundled_refs(150, 8, seed);
    EXPECT_EQ(areas_of(build_agglomerative_tree(refs, {})), greedy_areas(refs));
  }
  // Sizes over many orders of magnitude.
  Refs refs = random_refs(200, 9);
  for (std::size_t i = 0; i < refs.size(); ++i)
    refs[i].box.hi = refs[i].box.lo + Vec3d::all(std::ldexp(1.0, static_cast<int>(i % 20) - 18) *
                                                 (1.0 + 1e-3 * static_cast<double>(i)));
  EXPECT_EQ(areas_of(build_agglomerative_tree(refs, {})), greedy_areas(refs));
}

TEST(Agglomerative, ComesToAnEndOnDegenerateInput) {
  for (Input& input : degenerate_inputs()) {
    SCOPED_TRACE(input.name);
    input.refs.resize(1500);  // boxes within each other take quadratic time
    const Tree deep = make_tree(build_agglomerative_tree(input.refs, {}));
    const Tree tree = limit_depth(deep, 64, kCost, {});
    EXPECT_LE(tree.depth(), 64);
    TreeCheck{tree, input.refs, 1}.run();
  }
}

TEST(Agglomerative, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  BuildContext two;
  two.executor = Executor::with_threads(2);
  const Refs refs = random_refs(20000, 2);
  expect_equal(make_tree(build_agglomerative_tree(refs, {})),
               make_tree(build_agglomerative_tree(refs, two)));
}

TEST(Agglomerative, CanBeCancelled) {
  BuildContext context;
  context.progress = [&](double fraction, std::string_view) { return fraction < 0.5; };
  EXPECT_THROW(build_agglomerative_tree(random_refs(1000, 4), context), Error);
}

}  // namespace
}  // namespace strahl
