// Children in the order of their centres, and what visits by the ray's direction cost.
#include <string>
#include <tests/support/against_brute.h>
#include <tests/support/box_source.h>
#include <tests/support/mesh_maker.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/query/scene_visitor.h>
#include <strahl/structures/bvh/bvh_breaker_test.h>
#include <strahl/structures/bvh/child_order.h>

namespace strahl {

extern template class BvhTree<AabbVolume>;

namespace {

using namespace test;

Boxes random_boxes(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  Boxes source;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d lo{rng.uniform(), rng.uniform(), rng.uniform()};
    source.boxes.push_back(
        {lo, lo + Vec3d{rng.uniform(0, 0.2), rng.uniform(0, 0.2), rng.uniform(0, 0.2)}});
  }
  return source;
}

/// That children ascend along the axis of their parent, which is the one of the widest spread.
void expect_ordered(Bvh& bvh) {
  const auto& nodes = BvhBreaker::nodes(BvhBreaker::tree<AabbVolume>(bvh));
  for (const BvhNode<AabbVolume>& node : nodes) {
    if (node.is_leaf()) continue;
    Aabb centers;
    double last = -Aabb::kInf;
    for (std::uint32_t c = node.first; c < node.first + node.size(); ++c) {
      const Vec3d center = nodes[c].volume.box().center();
      EXPECT_GE(center[node.axis()] + 1e-6, last);  // stored as floats
      last = center[node.axis()];
      centers.extend(center);
    }
    const Vec3d extent = centers.extent();
    EXPECT_GE(extent[node.axis()] + 1e-6, std::max({extent.x, extent.y, extent.z}));
  }
}

TEST(ChildOrder, AscendsAlongTheWidestAxisOfTheCentresAlsoAfterMotion) {
  const Boxes before = random_boxes(300, 1), after = random_boxes(300, 2);
  for (const int arity : {2, 3, 16}) {
    BvhOptions options;
    options.arity = arity, options.leaf_size = 1, options.traversal = BvhTraversal::direction;
    options.rebuild_factor = 1000.0;
    Bvh bvh(before, options, {});
    EXPECT_NO_THROW(bvh.validate(before));
    expect_ordered(bvh);
    bvh.refit(after, {});
    EXPECT_EQ(bvh.refits(), 1u);
    EXPECT_NO_THROW(bvh.validate(after));
    expect_ordered(bvh);
  }
}

TEST(ChildOrder, KeepsEqualCentresInTheirOrderAndSubtreesWithTheirRoots) {
  Hierarchy tree;
  const Aabb left{{0, 0, 0}, {1, 1, 1}}, right{{4, 0, 0}, {5, 1, 1}};
  tree.nodes = {{Aabb::join(left, right), 1, 3, 0},
                {right, 4, 2, 0},
                {left, 0, 0, 1},
                {left, 1, 0, 1},
                {right, 2, 0, 1},
                {right, 3, 0, 1}};
  tree.references = {0, 1, 2, 3};
  const ChildOrder order = order_children(tree);
  EXPECT_EQ(order.axes[0], 0);
  EXPECT_EQ(order.from, (std::vector<std::uint32_t>{0, 2, 3, 1, 4, 5}));
  EXPECT_EQ(tree.nodes[1].first, 0u);
  EXPECT_EQ(tree.nodes[2].first, 1u);
  EXPECT_EQ(tree.nodes[3].first, 4u);
  EXPECT_EQ(tree.nodes[3].children, 2u);
  EXPECT_EQ(tree.nodes[4].first, 2u);
}

/// Eight squares across an axis, one behind the other.
ScenePtr row(int axis) {
  MeshMaker mesh;
  for (int i = 0; i < 8; ++i) {
    const auto corner = [&](double u, double v) {
      Vec3d p = Vec3d::all(v);
      p[axis] = i, p[(axis + 1) % 3] = u;
      return p;
    };
    mesh.triangle(corner(-1, -1), corner(3, -1), corner(-1, 3));
  }
  return mesh.scene();
}

/// Leaves visited by one closest hit along an axis through the row.
std::uint64_t leaves_met(const ScenePtr& scene, int axis, double sign, const std::string& options) {
  Ray ray;
  ray.org[axis] = sign > 0 ? -1.0 : 9.0, ray.dir[axis] = sign;
  return work_of(*build(scene, "bvh:leaf_size=1," + options), {ray}).leaves;
}

TEST(ChildOrder, LetsTheNearestComeFirstFromEitherSide) {
  for (int axis = 0; axis < 3; ++axis)
    for (const std::string arity : {"2", "4", "16"}) {
      const ScenePtr scene = row(axis);
      const auto met = [&](double sign, const std::string& traversal) {
        return leaves_met(scene, axis, sign, "arity=" + arity + ",traversal=" + traversal);
      };
      for (const double sign : {1.0, -1.0}) EXPECT_EQ(met(sign, "direction"), 1u) << arity;
      // The tree's own order suits one of the two at most.
      EXPECT_EQ(std::max(met(1.0, "dfs"), met(-1.0, "dfs")), 8u) << arity;
    }
}

TEST(ChildOrder, GoesByCentresAndNotByEntries) {
  // A long box that a ray along x enters first and is hit at x = 1, but with its centre at 5; and a
  // short one around x = 2.
  MeshMaker mesh;
  mesh.triangle({1, -1, 0}, {1, 3, -3}, {1, -1, 3});
  mesh.triangle({0, 5, 0}, {10, 5, 0}, {10, 5, 1});
  mesh.triangle({2, -1, -1}, {2, 3, -1}, {2, -1, 3});
  mesh.triangle({2.5, -1, -1}, {2.5, 3, -1}, {2.5, -1, 3});
  SceneData data;
  data.geometries = {mesh.geometry()};
  const auto scene = std::make_shared<const Scene>(std::move(data));
  Hierarchy tree;
  const Aabb wide = Aabb::join(scene->bounds(0), scene->bounds(1));
  const Aabb thin = Aabb::join(scene->bounds(2), scene->bounds(3));
  tree.nodes = {{Aabb::join(wide, thin), 1, 2, 0}, {wide, 0, 0, 2}, {thin, 2, 0, 2}};
  tree.references = {0, 1, 2, 3};
  const ChildOrder order = order_children(tree);
  EXPECT_EQ(tree.nodes[1].first, 2u);  // the short one comes first
  const std::vector<AabbVolume> volumes{
      AabbVolume(tree.nodes[0].box), AabbVolume(tree.nodes[1].box), AabbVolume(tree.nodes[2].box)};
  const BvhTree<AabbVolume> bvh(tree, volumes, tree.nodes[0].box, {1.0, 1.0}, order.axes);
  const Ray along{{-1, 0, 0}, {1, 0, 0}};
  const PreparedRay ray(along, scene->world_frame());
  const auto leaves_in = [&]<BvhOrder kOrder>() {
    ClosestHit query(along, {});
    SceneVisitor prims(*scene);
    Counters counters;
    prims.begin_ray();
    walk(BvhView<AabbVolume, kOrder>(bvh, ray), prims, ray, query, counters);
    EXPECT_EQ(query.best.t, 2.0);
    return counters.leaves;
  };
  EXPECT_EQ(leaves_in.operator()<BvhOrder::entry>(), 1u);      // nothing before x = 1 is left
  EXPECT_EQ(leaves_in.operator()<BvhOrder::direction>(), 2u);  // x = 2, then what may lie before
}

}  // namespace
}  // namespace strahl
