// End-point overlap of trees of any volumes and of nested trees: by its definition, at points.
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <tests/support/mesh_maker.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/catalog/catalog.h>
#include <strahl/geometry/surface_piece.h>
#include <strahl/structures/bvh/any_volume.h>
#include <strahl/structures/bvh/bvh.h>

namespace strahl {
namespace {

double overlap(const test::ScenePtr& scene, const std::string& spec) {
  return build(scene, spec)->end_point_overlap({}).value();
}

/// Triangles and, as a second geometry, spheres.
test::ScenePtr mixed_scene() {
  Rng rng(5);
  SceneData data;
  data.geometries = {test::soup(50, 0.5, 4).geometry(), {}};
  data.geometries[1].kind = PrimitiveKind::sphere, data.geometries[1].geometry_id = 1;
  for (int i = 0; i < 15; ++i)
    data.geometries[1].spheres.push_back(
        {{rng.uniform(), rng.uniform(), rng.uniform()}, rng.uniform(0.05, 0.3)});
  return std::make_shared<const Scene>(std::move(data));
}

struct Sample {
  std::uint32_t primitive;
  Vec3d point;
  double area;  ///< that it stands for
};

std::vector<Sample> sample(const Scene& scene, int count) {
  Rng rng(6);
  std::vector<Sample> samples;
  for (std::uint32_t i = 0; i < scene.size(); ++i)
    visit_shape(scene, i, [&]<class Shape>(const Shape& shape) {
      for (int k = 0; k < count; ++k) {
        double u = rng.uniform(), v = rng.uniform();
        if constexpr (std::is_same_v<Shape, TriangleVertices>) {
          if (u + v > 1) u = 1 - u, v = 1 - v;
          const double area = 0.5 * length(cross(shape.b - shape.a, shape.c - shape.a));
          samples.push_back(
              {i, shape.a + u * (shape.b - shape.a) + v * (shape.c - shape.a), area / count});
        } else {
          const Vec3d p = shape.point(std::acos(1 - 2 * u), 2 * std::numbers::pi * v);
          samples.push_back({i, p, shape.area(shape.whole()) / count});
        }
      }
    });
  return samples;
}

/// Of one node and all below it. @param owns whether the primitive is below, per node
template <class V>
double cost_at(const std::vector<BvhNode<V>>& nodes, const std::vector<bool>& owns,
               std::uint32_t at, const Vec3d& p) {
  const BvhNode<V>& node = nodes[at];
  double sum = 0.0;
  if (!owns[at]) {
    if (!node.volume.contains(p)) return 0.0;
    sum = node.is_leaf() ? node.size() : 1.0;
  }
  for (std::uint32_t c = 0; c < node.size() && !node.is_leaf(); ++c)
    sum += cost_at(nodes, owns, node.first + c, p);
  return sum;
}

template <class V>
double sampled_overlap(const BvhTree<V>& tree, const std::vector<Sample>& samples) {
  double surface = 0.0, overlap = 0.0;
  std::vector<bool> owns;
  std::uint32_t last = ~0u;
  for (const Sample& s : samples) {
    if (s.primitive != last) {
      owns.assign(tree.nodes().size(), false);
      for (std::size_t n = owns.size(); n-- > 0;) {
        const BvhNode<V>& node = tree.nodes()[n];
        for (std::uint32_t c = node.first; c < node.first + node.size(); ++c)
          if (node.is_leaf() ? tree.references()[c] == s.primitive : owns[c]) owns[n] = true;
      }
      last = s.primitive;
    }
    surface += s.area;
    overlap += s.area * cost_at(tree.nodes(), owns, 0, s.point);
  }
  return overlap / surface;
}

template <class V>
void expect_sampled(const test::ScenePtr& scene, const std::string& kind, BvhVolume bv,
                    const std::vector<Sample>& samples) {
  BvhOptions options;
  options.bv = bv, options.leaf_size = 2, options.arity = 3;
  const Bvh bvh(*scene, options, {});
  const auto& tree = dynamic_cast<const BvhTree<V>&>(*bvh.tree());
  const double expected = sampled_overlap(tree, samples);
  EXPECT_GT(expected, 0.5) << kind;
  EXPECT_NEAR(overlap(scene, "bvh:arity=3,leaf_size=2,bv=" + kind), expected, 0.015 * expected)
      << kind;
}

TEST(VolumeOverlap, IsWhatRandomPointsSayForEveryKind) {
  const test::ScenePtr scene = mixed_scene();
  const std::vector<Sample> samples = sample(*scene, 500);
  for (const BoundingVolumeInfo& info : kBoundingVolumes)
    with_volume_type(info.kind, [&]<class V>() {
      expect_sampled<V>(scene, std::string(info.name), static_cast<BvhVolume>(info.kind), samples);
    });
  expect_sampled<AnyVolume>(scene, "auto", BvhVolume::automatic, samples);
}

TEST(VolumeOverlap, OfBoxesIsTheSameHoweverTheyAreSaid) {
  const test::ScenePtr scene = mixed_scene();
  const double boxes = overlap(scene, "bvh");
  EXPECT_EQ(overlap(scene, "bvh:bv=kdop6"), boxes);
  // One instance: the top is a leaf that owns everything. Here boxes are six sides each.
  EXPECT_NEAR(overlap(scene, "two_level"), boxes, 0.005 * boxes);
  const test::ScenePtr triangles = test::soup(100, 0.4, 7).scene();
  EXPECT_NEAR(overlap(triangles, "two_level"), overlap(triangles, "bvh"), 1e-9);
  EXPECT_NEAR(overlap(triangles, "two_level:bottom=wide_bvh"), overlap(triangles, "wide_bvh"),
              1e-4);
}

TEST(VolumeOverlap, OfOrientedBoxesOfFlatPartsIsThatOfTheirPlane) {
  // Boxes along the axes fit best, and are nearly found.
  test::MeshMaker mesh;
  Rng rng(8);
  for (int i = 0; i < 60; ++i) {
    const double x = rng.uniform(), y = rng.uniform(), z = rng.uniform(0, 0.02);
    mesh.triangle({x, y, z}, {x + 0.3, y, z}, {x, y + 0.3, z});
    mesh.triangle({x + 0.3, y + 0.3, z}, {x, y + 0.3, z}, {x + 0.3, y, z});
  }
  const test::ScenePtr scene = mesh.scene();
  const double boxes = overlap(scene, "bvh"), oriented = overlap(scene, "bvh:bv=obb");
  EXPECT_NEAR(oriented, boxes, 0.1 * boxes);
  EXPECT_LE(overlap(scene, "bvh:bv=intersection"), 1.0001 * std::min(boxes, oriented));
}

/// The two triangles of EndPointOverlap.IsWhatAHandComputes, placed: each by itself has an overlap
/// of 4 of a surface of 16; a tree of leaves of one over both costs 16 + 10 + 10 for the surface of
/// another pair in the same place.
test::ScenePtr pairs(const std::vector<Affine>& maps) {
  test::MeshMaker mesh;
  mesh.triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  mesh.triangle({6, 0, 0}, {2, 0, 0}, {6, 4, 0});
  SceneData data;
  data.geometries = {mesh.geometry()};
  for (std::uint32_t i = 0; i < maps.size(); ++i) data.instances.push_back({0, 1, maps[i], i});
  return std::make_shared<const Scene>(std::move(data));
}

const std::string kSingles = "bottom=(bvh:leaf_size=1)";

TEST(NestedOverlap, IsWhatAHandComputes) {
  const Affine here, far = Affine::translation({0, 0, 100});
  EXPECT_NEAR(overlap(pairs({here, far}), "two_level:" + kSingles), 4.0 / 16.0, 1e-6);
  const test::ScenePtr twins = pairs({here, here});
  // The top is one leaf: nothing is foreign to it.
  EXPECT_NEAR(overlap(twins, "two_level:" + kSingles), (4.0 + 36.0) / 16.0, 1e-6);
  // Leaves of one instance each: one is foreign, and so is one reference.
  EXPECT_NEAR(overlap(twins, "two_level:top=(bvh:leaf_size=1)," + kSingles), (4 + 36 + 16) / 16.0,
              1e-6);
}

TEST(NestedOverlap, GoesDownRunsOfInstancesAndOfPrimitives) {
  const test::ScenePtr four = pairs(std::vector<Affine>(4));
  EXPECT_NEAR(overlap(four, "two_level:" + kSingles), (4.0 + 3 * 36.0) / 16.0, 1e-6);
  // Two runs of two instances: the leaf of the other run costs its two references.
  EXPECT_NEAR(overlap(four, "two_level:top=two_level," + kSingles),
              (4.0 + 3 * 36.0 + 2 * 16.0) / 16.0, 1e-6);
  // A run of two primitives above the same tree: one leaf of one reference more, three times.
  EXPECT_NEAR(overlap(four, "two_level:bottom=(two_level:" + kSingles + ")"),
              (4.0 + 3 * (36.0 + 16.0)) / 16.0, 1e-6);
}

TEST(NestedOverlap, DoesNotChangeWhereAllIsTurnedAndScaled) {
  const Affine turned = Affine::translation({5, -3, 2}) *
                        Affine::rotation(0.5, 0.1, -0.3, std::sqrt(1 - 0.35)) *
                        Affine::scaling({3, 3, 3});
  const auto both = [&](const std::string& spec, const Affine& map) {
    return overlap(pairs({map, map * Affine::translation({1.5, 0.5, 0})}), spec);
  };
  for (const std::string kind : {"aabb", "obb", "sphere", "cylinder"}) {
    const std::string spec = "two_level:bottom=(bvh:leaf_size=1,bv=" + kind + ")";
    const double plain = both(spec, {});
    EXPECT_GT(plain, 1.0) << kind;
    EXPECT_NEAR(both(spec, turned), plain, 0.01 * plain) << kind;
  }
}

TEST(NestedOverlap, FollowsMotion) {
  const test::ScenePtr apart = pairs({Affine{}, Affine::translation({0, 0, 100})});
  const auto built = build(apart, "two_level:" + kSingles);
  const std::vector<Affine> together(2);
  built->update(std::make_shared<const Scene>(apart->posed(together)), {});
  EXPECT_NEAR(built->end_point_overlap({}).value(), 40.0 / 16.0, 1e-6);
}

TEST(NestedOverlap, IsNoneWhereALevelIsNoTreeOfVolumes) {
  const test::ScenePtr twins = pairs({Affine{}, Affine{}});
  for (const char* spec : {"two_level:top=grid", "two_level:bottom=kd_tree",
                           "two_level:bottom=(two_level:top=octree)", "grid", "brute_force"})
    EXPECT_FALSE(build(twins, spec)->end_point_overlap({})) << spec;
  EXPECT_EQ(overlap(std::make_shared<const Scene>(SceneData{}), "two_level"), 0.0);
}

TEST(NestedOverlap, IsTheSameForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  BuildContext two;
  two.executor = Executor::with_threads(2);
  const auto built = build(mixed_scene(), "two_level:bottom=(bvh:bv=sphere)");
  EXPECT_EQ(built->end_point_overlap({}), built->end_point_overlap(two));
}

}  // namespace
}  // namespace strahl
