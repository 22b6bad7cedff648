#include <algorithm>
#include <string>
#include <tests/support/hierarchy_check.h>
#include <tests/support/tree_cases.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/structures/bvh/bvh_build.h>

namespace strahl {
namespace {

using namespace test;

/// Boxes and nothing else.
struct Boxes final : PrimitiveSource {
  Refs refs;

  explicit Boxes(Refs boxes) : refs(std::move(boxes)) {}
  std::uint32_t size() const override { return static_cast<std::uint32_t>(refs.size()); }
  Aabb bounds(std::uint32_t i) const override { return refs[i].box; }
  Aabb clip(std::uint32_t i, const Aabb& box) const override {
    return Aabb::intersection(refs[i].box, box);
  }
};

/// Every builder with every optimiser.
std::vector<BvhOptions> all_options(int leaf_size) {
  std::vector<BvhOptions> all;
  for (int builder = 0; builder <= static_cast<int>(BvhBuilder::ploc); ++builder)
    for (const BvhOptimise optimise :
         {BvhOptimise::none, BvhOptimise::rotations, BvhOptimise::reinsertion}) {
      BvhOptions options;
      options.builder = static_cast<BvhBuilder>(builder);
      options.optimise = optimise, options.leaf_size = leaf_size;
      all.push_back(options);
    }
  return all;
}

bool is_cut(const BvhOptions& options) { return options.builder == BvhBuilder::spatial; }

std::string name_of(const BvhOptions& options) { return format_options(options); }

TEST(BvhBuild, HoldsItsInvariantsWhateverTheBuilder) {
  const Boxes source(random_refs(700, 1));
  for (const int leaf_size : {1, 4})
    for (const BvhOptions& options : all_options(leaf_size)) {
      SCOPED_TRACE(name_of(options));
      const Hierarchy tree = build_bvh_hierarchy(source, options, {});
      check_hierarchy(tree, source.refs, static_cast<std::size_t>(leaf_size), options.arity,
                      is_cut(options));
      EXPECT_LE(tree.depth(), kBvhMaxDepth);
    }
}

TEST(BvhBuild, MakesWideNodesOnlyWhereAsked) {
  const Boxes source(random_refs(700, 3));
  for (const int arity : {2, 3, 8, kBvhMaxArity})
    for (BvhOptions options : all_options(2)) {
      options.arity = arity;
      SCOPED_TRACE(name_of(options));
      const Hierarchy tree = build_bvh_hierarchy(source, options, {});
      check_hierarchy(tree, source.refs, 2, arity, is_cut(options));
      std::uint32_t most = 0;
      for (const HierarchyNode& node : tree.nodes) most = std::max(most, node.children);
      EXPECT_GT(most, arity == 2 ? 1u : 2u);
    }
}

TEST(BvhBuild, StaysWithinTheDepthBoundOnDegenerateInput) {
  for (Input& input : degenerate_inputs()) {
    input.refs.resize(500);
    const Boxes source(input.refs);
    for (const BvhOptions& options : all_options(1)) {
      SCOPED_TRACE(input.name + ", " + name_of(options));
      const Hierarchy tree = build_bvh_hierarchy(source, options, {});
      check_hierarchy(tree, source.refs, 1, options.arity, is_cut(options));
      EXPECT_LE(tree.depth(), kBvhMaxDepth);
    }
  }
}

TEST(BvhBuild, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const Boxes source(random_refs(5000, 2));
  BuildContext two;
  two.executor = Executor::with_threads(2);
  for (const BvhOptions& options : all_options(2)) {
    if (options.optimise != BvhOptimise::none && options.builder != BvhBuilder::lbvh) continue;
    SCOPED_TRACE(name_of(options));
    const Hierarchy a = build_bvh_hierarchy(source, options, {});
    const Hierarchy b = build_bvh_hierarchy(source, options, two);
    EXPECT_EQ(a.references, b.references);
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    for (std::size_t i = 0; i < a.nodes.size(); ++i)
      ASSERT_TRUE(a.nodes[i].box == b.nodes[i].box && a.nodes[i].first == b.nodes[i].first);
  }
}

TEST(BvhBuild, OptimisersDoNotRaiseTheCostOfSinglePrimitives) {
  const Boxes source(random_refs(1000, 3));
  std::vector<double> cost;
  for (const BvhOptions& options : all_options(1))
    cost.push_back(build_bvh_hierarchy(source, options, {}).sah_cost({1.0, 1.0}));
  for (std::size_t i = 0; i < cost.size(); i += 3) {
    // Insertion makes pairs only where it is optimised, else wider nodes.
    if (i / 3 == static_cast<std::size_t>(BvhBuilder::goldsmith_salmon)) continue;
    EXPECT_LE(cost[i + 1], cost[i] * (1 + 1e-12)) << i;
    EXPECT_LE(cost[i + 2], cost[i] * (1 + 1e-12)) << i;
  }
}

/// Long thin boxes along all axes, one of them a diagonal's.
Refs sticks(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    Vec3d lo{rng.uniform(), rng.uniform(), rng.uniform()}, hi = lo + Vec3d::all(0.005);
    hi[static_cast<int>(rng.below(3))] += rng.uniform(0.1, 0.6);
    boxes.push_back({lo, hi});
  }
  return refs_of(boxes);
}

TEST(BvhBuild, CutsWithinTheBudgetAndOnlyWhereThatIsCheaper) {
  const Boxes source(sticks(1000, 5));
  BvhOptions options;
  options.leaf_size = 1, options.optimise = BvhOptimise::reinsertion;
  const double whole = build_bvh_hierarchy(source, options, {}).sah_cost({1.0, 1.0});
  options.builder = BvhBuilder::spatial;
  double before = 1.05 * whole;
  for (const double duplicates : {0.0, 0.3, 2.0}) {
    options.duplicates = duplicates;
    const Hierarchy tree = build_bvh_hierarchy(source, options, {});
    check_hierarchy(tree, source.refs, 1, 2, true);
    const auto references = static_cast<double>(tree.references.size());
    EXPECT_LE(references, 1000 * (1.0 + duplicates));
    EXPECT_GE(references, 1000 * (1.0 + 0.5 * duplicates));
    const double cost = tree.sah_cost({1.0, 1.0});
    EXPECT_LT(cost, duplicates > 0.0 ? 0.98 * before : before) << duplicates;
    before = cost;
  }
}

TEST(BvhBuild, KeepsToTheMemoryLimitAndCanBeCancelled) {
  const Boxes source(random_refs(2000, 4));
  for (const BvhOptions& options : all_options(4)) {
    SCOPED_TRACE(name_of(options));
    BuildContext small;
    small.memory_limit = 200'000;
    EXPECT_THROW(build_bvh_hierarchy(source, options, small), Error);
    for (const double end : {0.0, 0.4}) {
      BuildContext context;
      context.progress = [&](double fraction, std::string_view stage) {
        return stage == "bounding primitives" || fraction < end;
      };
      EXPECT_THROW(build_bvh_hierarchy(source, options, context), Error);
    }
  }
}

}  // namespace
}  // namespace strahl
