#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/build/end_point_overlap.h>
#include <strahl/build/object_tree.h>
#include <strahl/geometry/outline.h>

namespace strahl {
namespace {

struct Triangles final : PrimitiveSource {
  std::vector<TriangleVertices> list;

  std::uint32_t size() const override { return static_cast<std::uint32_t>(list.size()); }
  Aabb bounds(std::uint32_t i) const override { return list[i].bounds(); }
  Aabb clip(std::uint32_t i, const Aabb& box) const override {
    return Aabb::intersection(bounds(i), box);
  }
  Outline outline(std::uint32_t i) const override { return outline_of(list[i], Affine{}); }
};

/// A leaf for each triangle below a root of all.
Hierarchy flat(const Triangles& source) {
  Hierarchy tree;
  tree.nodes.push_back({{}, 1, source.size(), 0});
  for (std::uint32_t i = 0; i < source.size(); ++i) {
    tree.nodes.push_back({source.bounds(i), i, 0, 1});
    tree.references.push_back(i);
    tree.nodes[0].box.extend(source.bounds(i));
  }
  return tree;
}

TEST(EndPointOverlap, IsZeroWhereBoxesAreApart) {
  Triangles source;
  source.list = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{3, 0, 0}, {4, 0, 0}, {3, 1, 0}}};
  EXPECT_EQ(end_point_overlap(flat(source), source, {1.0, 1.0}, {}), 0.0);
}

TEST(EndPointOverlap, IsWhatAHandComputes) {
  // Two triangles of area 8 in one plane, mirrored about x = 3; the boxes [0,4] and [2,6] have the
  // strip 2 <= x <= 4 in common, of height 4. In it lie a triangle of 2 by 2 of the first one...
  Triangles source;
  source.list = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{6, 0, 0}, {2, 0, 0}, {6, 4, 0}}};
  const Hierarchy tree = flat(source);
  // ... and one of the second: each 2, of 16 in all.
  EXPECT_DOUBLE_EQ(end_point_overlap(tree, source, {1.0, 1.0}, {}), 4.0 / 16.0);
  // Leaves cost by intersection, the root holds nothing foreign.
  EXPECT_DOUBLE_EQ(end_point_overlap(tree, source, {7.0, 3.0}, {}), 3.0 * 4.0 / 16.0);
}

TEST(EndPointOverlap, CountsInnerNodesByTheirStep) {
  // A pair of triangles whose common box holds a third, of another part of the tree.
  Triangles source;
  source.list = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                 {{9, 9, 0}, {10, 9, 0}, {10, 10, 0}},
                 {{4, 4, 0}, {6, 4, 0}, {4, 6, 0}}};
  Hierarchy tree;
  tree.nodes = {{{{0, 0, 0}, {10, 10, 0}}, 1, 2, 0},
                {{{0, 0, 0}, {10, 10, 0}}, 3, 2, 0},
                {source.bounds(2), 2, 0, 1},
                {source.bounds(0), 0, 0, 1},
                {source.bounds(1), 1, 0, 1}};
  tree.references = {0, 1, 2};
  EXPECT_DOUBLE_EQ(end_point_overlap(tree, source, {5.0, 1.0}, {}), 5.0 * 2.0 / 3.0);
}

TEST(EndPointOverlap, AgreesWithRandomPoints) {
  Rng rng(1);
  const auto point = [&](double size) {
    return Vec3d{rng.uniform(0, size), rng.uniform(0, size), rng.uniform(0, size)};
  };
  Triangles source;
  for (int i = 0; i < 60; ++i) {
    const Vec3d at = point(1.0);
    source.list.push_back({at, at + point(0.6), at + point(0.6)});
  }
  std::vector<PrimRef> refs = make_prim_refs(source, {});
  Aabb box;
  for (const PrimRef& ref : refs) box.extend(ref.box);
  const auto splitter = make_sweep_splitter(refs, {1.0, 1.0});
  const Hierarchy tree =
      make_hierarchy(build_object_tree(*splitter, 60, box, {{1.0, 1.0}, 2, 64}, {}));
  const SahCost cost{1.0, 2.0};
  double surface = 0.0, weighted = 0.0;
  constexpr int kPoints = 20000;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const TriangleVertices& t = source.list[i];
    const double area = 0.5 * length(cross(t.b - t.a, t.c - t.a));
    surface += area;
    for (int k = 0; k < kPoints / 60; ++k) {
      double u = rng.uniform(), v = rng.uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3d p = t.a + u * (t.b - t.a) + v * (t.c - t.a);
      // All nodes that hold the point, but for those above the triangle's leaf.
      std::vector<bool> owns(tree.nodes.size(), false);
      for (std::size_t n = tree.nodes.size(); n-- > 0;) {
        const HierarchyNode& node = tree.nodes[n];
        for (std::uint32_t c = 0; c < node.children; ++c) owns[n] = owns[n] || owns[node.first + c];
        for (std::uint32_t r = 0; r < node.count; ++r)
          owns[n] = owns[n] || tree.references[node.first + r] == i;
        if (!owns[n] && node.box.contains(p))
          weighted += area / (kPoints / 60) *
                      (node.is_leaf() ? cost.intersect * node.count : cost.traverse);
      }
    }
  }
  const double sampled = weighted / surface;
  EXPECT_NEAR(end_point_overlap(tree, source, cost, {}), sampled, 0.02 * sampled);
}

TEST(EndPointOverlap, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  Rng rng(2);
  Triangles source;
  for (int i = 0; i < 300; ++i)
    source.list.push_back({{rng.uniform(), rng.uniform(), 0},
                           {rng.uniform(), rng.uniform(), 1},
                           {rng.uniform(), rng.uniform(), 2}});
  BuildContext two;
  two.executor = Executor::with_threads(2);
  const Hierarchy tree = flat(source);
  EXPECT_EQ(end_point_overlap(tree, source, {}, {}), end_point_overlap(tree, source, {}, two));
  BuildContext cancelled;
  cancelled.progress = [](double, std::string_view) { return false; };
  EXPECT_THROW(end_point_overlap(tree, source, {}, cancelled), Error);
}

}  // namespace
}  // namespace strahl
