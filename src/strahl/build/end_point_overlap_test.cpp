#include <memory>
#include <numbers>
#include <tests/support/mesh_maker.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/build/end_point_overlap.h>
#include <strahl/build/object_tree.h>
#include <strahl/geometry/surface_piece.h>

namespace strahl {
namespace {

constexpr double kPi = std::numbers::pi;

/// A leaf for each primitive below a root of all.
Hierarchy flat(const Scene& scene) {
  Hierarchy tree;
  tree.nodes.push_back({{}, 1, scene.size(), 0});
  for (std::uint32_t i = 0; i < scene.size(); ++i) {
    tree.nodes.push_back({scene.bounds(i), i, 0, 1});
    tree.references.push_back(i);
    tree.nodes[0].box.extend(scene.bounds(i));
  }
  return tree;
}

/// Leaves of two at most.
Hierarchy divided(const Scene& scene) {
  std::vector<PrimRef> refs = make_prim_refs(scene, {});
  Aabb box;
  for (const PrimRef& ref : refs) box.extend(ref.box);
  const std::size_t count = refs.size();
  const auto splitter = make_sweep_splitter(refs, {1.0, 1.0});
  return make_hierarchy(build_object_tree(*splitter, count, box, {{1.0, 1.0}, 2, 64}, {}));
}

double cost_of(const HierarchyNode& node, const VisitCost& cost) {
  return node.is_leaf() ? cost.leaf + cost.reference * node.count : cost.inner;
}

/// Whether the primitive is below, for each node.
std::vector<bool> owners(const Hierarchy& tree, std::uint32_t primitive) {
  std::vector<bool> owns(tree.nodes.size(), false);
  for (std::size_t n = tree.nodes.size(); n-- > 0;) {
    const HierarchyNode& node = tree.nodes[n];
    for (std::uint32_t c = 0; c < node.children; ++c)
      if (owns[node.first + c]) owns[n] = true;
    for (std::uint32_t r = 0; r < node.count; ++r)
      if (tree.references[node.first + r] == primitive) owns[n] = true;
  }
  return owns;
}

/// The definition: every primitive against every node.
double naive(const BoxTree& tree, const Scene& scene) {
  double surface = 0.0, overlap = 0.0;
  for (std::uint32_t i = 0; i < scene.size(); ++i) {
    const std::vector<bool> owns = owners(tree.nodes, i);
    visit_surface(scene, i, [&](const auto& whole) {
      surface += whole.area();
      for (std::size_t n = 0; n < tree.nodes.nodes.size(); ++n) {
        if (owns[n]) continue;
        auto piece = whole;
        piece.cut_to(tree.nodes.nodes[n].box);
        if (!piece.is_empty()) overlap += piece.area() * cost_of(tree.nodes.nodes[n], tree.cost);
      }
    });
  }
  return overlap / surface;
}

TEST(EndPointOverlap, IsZeroWhereBoxesAreApart) {
  test::MeshMaker mesh;
  mesh.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.triangle({3, 0, 0}, {4, 0, 0}, {3, 1, 0});
  const test::ScenePtr scene = mesh.scene();
  EXPECT_EQ(end_point_overlap(BoxTree{flat(*scene), {}}, *scene, {}), 0.0);
}

TEST(EndPointOverlap, IsWhatAHandComputes) {
  // Two triangles of area 8 in one plane, mirrored about x = 3; the boxes [0,4] and [2,6] have the
  // strip 2 <= x <= 4 in common, of height 4. In it lie a triangle of 2 by 2 of the first one...
  test::MeshMaker mesh;
  mesh.triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  mesh.triangle({6, 0, 0}, {2, 0, 0}, {6, 4, 0});
  const test::ScenePtr scene = mesh.scene();
  const Hierarchy tree = flat(*scene);
  // ... and one of the second: each 2, of 16 in all.
  EXPECT_DOUBLE_EQ(end_point_overlap(BoxTree{tree, {}}, *scene, {}), 4.0 / 16.0);
  // Leaves cost by what they hold, the root holds nothing foreign.
  EXPECT_DOUBLE_EQ(end_point_overlap(BoxTree{tree, {7.0, 0.5, 3.0}}, *scene, {}), 3.5 * 4.0 / 16.0);
}

TEST(EndPointOverlap, CountsInnerNodesByTheirStep) {
  // A pair of triangles whose common box holds a third, of another part of the tree.
  test::MeshMaker mesh;
  mesh.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.triangle({9, 9, 0}, {10, 9, 0}, {10, 10, 0});
  mesh.triangle({4, 4, 0}, {6, 4, 0}, {4, 6, 0});
  const test::ScenePtr scene = mesh.scene();
  Hierarchy tree;
  tree.nodes = {{{{0, 0, 0}, {10, 10, 0}}, 1, 2, 0},
                {{{0, 0, 0}, {10, 10, 0}}, 3, 2, 0},
                {scene->bounds(2), 2, 0, 1},
                {scene->bounds(0), 0, 0, 1},
                {scene->bounds(1), 1, 0, 1}};
  tree.references = {0, 1, 2};
  EXPECT_DOUBLE_EQ(end_point_overlap(BoxTree{tree, {5.0, 0.0, 1.0}}, *scene, {}), 5.0 * 2.0 / 3.0);
}

/// Two unit spheres 1.5 apart: in the box of each lies a cap of the other of height 1/2.
Geometry two_balls() {
  Geometry g;
  g.kind = PrimitiveKind::sphere;
  g.spheres = {{{0, 0, 0}, 1.0}, {{1.5, 0, 0}, 1.0}};
  return g;
}

TEST(EndPointOverlap, OfSpheresIsThatOfCaps) {
  SceneData data;
  data.geometries = {two_balls()};
  const Scene scene(std::move(data));
  const double expected = 2.0 * (2.0 * kPi * 0.5) / (2.0 * 4.0 * kPi);
  EXPECT_NEAR(end_point_overlap(BoxTree{flat(scene), {}}, scene, {}), expected, 0.001);
}

TEST(EndPointOverlap, DoesNotChangeWithTheScaleOfAnInstance) {
  SceneData data;
  data.geometries = {two_balls()};
  data.instances = {{0, 1, Affine::translation({9, 0, 0}) * Affine::scaling({3, 3, 3}), 0}};
  const Scene scene(std::move(data));
  EXPECT_NEAR(end_point_overlap(BoxTree{flat(scene), {}}, scene, {}), 0.25, 0.001);
}

TEST(EndPointOverlap, AgreesWithRandomPoints) {
  Rng rng(1);
  const test::ScenePtr scene = test::soup(60, 0.5, 1).scene();
  const BoxTree tree{divided(*scene), {1.0, 0.0, 2.0}};
  double surface = 0.0, weighted = 0.0;
  constexpr int kPoints = 400;
  for (std::uint32_t i = 0; i < scene->size(); ++i) {
    const TriangleVertices t = scene->geometries()[0].mesh[i];
    const double area = 0.5 * length(cross(t.b - t.a, t.c - t.a));
    const std::vector<bool> owns = owners(tree.nodes, i);
    surface += area;
    for (int k = 0; k < kPoints; ++k) {
      double u = rng.uniform(), v = rng.uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3d p = t.a + u * (t.b - t.a) + v * (t.c - t.a);
      for (std::size_t n = 0; n < tree.nodes.nodes.size(); ++n)
        if (!owns[n] && tree.nodes.nodes[n].box.contains(p))
          weighted += area / kPoints * cost_of(tree.nodes.nodes[n], tree.cost);
    }
  }
  const double sampled = weighted / surface;
  EXPECT_NEAR(end_point_overlap(tree, *scene, {}), sampled, 0.02 * sampled);
}

TEST(EndPointOverlap, IsThatOfEveryPrimitiveAgainstEveryNode) {
  const test::ScenePtr scene = test::soup(200, 0.2, 2).scene();
  const BoxTree tree{divided(*scene), {1.0, 0.3, 2.0}};
  const double expected = naive(tree, *scene);
  EXPECT_GT(expected, 0.1);
  EXPECT_NEAR(end_point_overlap(tree, *scene, {}), expected, 1e-9 * expected);
  // As sides of volumes, whose boxes are floats rounded outward.
  EXPECT_NEAR(end_point_overlap(make_side_tree(tree), *scene, {}), expected, 1e-5 * expected);
}

TEST(EndPointOverlap, IsThatForPlacedThingsOfAllKinds) {
  Rng rng(3);
  const auto point = [&] { return Vec3d{rng.uniform(), rng.uniform(), rng.uniform()}; };
  SceneData data;
  data.geometries = {test::soup(20, 0.2, 3).geometry(), {}, {}};
  data.geometries[1].kind = PrimitiveKind::sphere, data.geometries[2].kind = PrimitiveKind::cone;
  for (int i = 0; i < 10; ++i) {
    data.geometries[1].spheres.push_back({point(), rng.uniform(0.05, 0.3)});
    data.geometries[2].cones.push_back({point(), rng.uniform(0.0, 0.2), point(), 0.1});
  }
  data.instances = {{0, 3, Affine{}, 0},
                    {0, 3, Affine::translation({0.5, 0, 0}) * Affine::scaling({1, 2, 0.5}), 1}};
  const Scene scene(std::move(data));
  const BoxTree tree{divided(scene), {1.0, 0.3, 2.0}};
  const double expected = naive(tree, scene);
  EXPECT_GT(expected, 0.1);
  EXPECT_NEAR(end_point_overlap(tree, scene, {}), expected, 0.005 * expected);
}

TEST(EndPointOverlap, AllLeavesOfACutPrimitiveOwnIt) {
  test::MeshMaker mesh;
  mesh.triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  const test::ScenePtr scene = mesh.scene();
  Hierarchy tree;
  tree.nodes = {{scene->bounds(0), 1, 2, 0},
                {{{0, 0, 0}, {2, 4, 0}}, 0, 0, 1},
                {{{1, 0, 0}, {4, 4, 0}}, 1, 0, 1}};
  tree.references = {0, 0};
  EXPECT_EQ(end_point_overlap(BoxTree{tree, {}}, *scene, {}), 0.0);
}

TEST(EndPointOverlap, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const test::ScenePtr scene = test::soup(300, 0.5, 4).scene();
  BuildContext two;
  two.executor = Executor::with_threads(2);
  const BoxTree tree{flat(*scene), {}};
  EXPECT_EQ(end_point_overlap(tree, *scene, {}), end_point_overlap(tree, *scene, two));
  BuildContext cancelled;
  cancelled.progress = [](double, std::string_view) { return false; };
  EXPECT_THROW(end_point_overlap(tree, *scene, cancelled), Error);
}

}  // namespace
}  // namespace strahl
