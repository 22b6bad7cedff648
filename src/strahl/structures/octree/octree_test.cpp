#include <array>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>
#include <strahl/structures/octree/octree.h>

namespace strahl {
namespace {

using ScenePtr = std::shared_ptr<const Scene>;

using Triangle = std::array<Vec3d, 3>;

ScenePtr triangles(const std::vector<Triangle>& all) {
  std::vector<Vec3d> vertices;
  std::vector<std::uint32_t> indices;
  for (const Triangle& triangle : all)
    for (const Vec3d& v : triangle) {
      indices.push_back(static_cast<std::uint32_t>(vertices.size()));
      vertices.push_back(v);
    }
  SceneData data;
  Geometry geometry;
  geometry.mesh = make_mesh(vertices, indices);
  data.geometries.push_back(std::move(geometry));
  return std::make_shared<const Scene>(std::move(data));
}

ScenePtr soup(std::size_t count, double size, std::uint64_t seed) {
  Rng rng(seed);
  const auto near = [&](const Vec3d& c, double reach) {
    return c + Vec3d{rng.uniform(-reach, reach), rng.uniform(-reach, reach),
                     rng.uniform(-reach, reach)};
  };
  std::vector<Triangle> all;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d c = near({0.5, 0.5, 0.5}, 0.5);
    all.push_back({near(c, size), near(c, size), near(c, size)});
  }
  return triangles(all);
}

std::vector<Ray> rays_through(const Scene& scene, std::size_t count) {
  Rng rng(5);
  const Aabb box = scene.total_bounds();
  const auto anywhere = [&] {
    Vec3d p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = box.lo[axis] + rng.uniform(-0.2, 1.2) * box.extent()[axis];
    return p;
  };
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d from = anywhere();
    rays.push_back({from, anywhere() - from});
  }
  return rays;
}

const char* const kKinds[] = {"octree",
                              "octree:exact=off",
                              "octree:split=middle",
                              "octree:place=inner",
                              "octree:place=inner,looseness=2",
                              "octree:place=inner,looseness=2,split=middle"};

TEST(Octree, AnEmptySceneHasAnEmptyLeaf) {
  const Scene scene{SceneData{}};
  const Octree structure(scene, {}, {});
  EXPECT_EQ(structure.report().empty_leaves, 1u);
  structure.validate(scene);
}

TEST(Octree, DividesCellsIntoEight) {
  for (const char* kind : kKinds) {
    const auto tree = build(soup(2000, 0.02, 12), kind);
    EXPECT_NO_THROW(tree->validate()) << kind;
    const BuildReport& report = tree->report();
    EXPECT_GT(report.leaves, 64u);
    EXPECT_EQ(report.leaves, 7 * (report.nodes - report.leaves) + 1) << kind;
    EXPECT_GE(report.bytes, 12 * report.nodes + 4 * report.references) << kind;
  }
}

TEST(Octree, RefersOnceToWhatIsAtInnerNodes) {
  const ScenePtr scene = soup(3000, 0.05, 1);
  for (const char* kind : {"octree:place=inner", "octree:place=inner,looseness=2"}) {
    const auto tree = build(scene, kind);
    EXPECT_NO_THROW(tree->validate());
    EXPECT_EQ(tree->report().references, 3000u);
  }
}

std::uint64_t tests_per(const ScenePtr& scene, const std::string& spec) {
  const std::vector<Ray> rays = rays_through(*scene, 500);
  std::vector<Hit> hits(rays.size());
  BatchContext context;
  context.count_work = true;
  return build(scene, spec)->closest_hit(make_batch(rays), hits, context).counters.primitives;
}

/// A sheet of small triangles that the first plane cuts.
TEST(Octree, EnlargedCellsLetSmallPrimitivesDown) {
  Rng rng(10);
  std::vector<Triangle> all{{Vec3d{0, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}},
                            {Vec3d{1, 0, 0}, Vec3d{1, 1, 0}, Vec3d{1, 0, 1}}};
  for (int i = 0; i < 2000; ++i) {
    const Vec3d at{0.5, rng.uniform(), rng.uniform()};
    all.push_back({at + Vec3d{-0.004, -0.01, -0.01}, at + Vec3d{0.004, -0.01, 0.01},
                   at + Vec3d{0.004, 0.01, 0.01}});
  }
  const ScenePtr scene = triangles(all);
  const std::string common = "octree:place=inner,split=middle";
  EXPECT_LT(tests_per(scene, common + ",looseness=2") * 4, tests_per(scene, common));
}

/// All but a frame lies in a small corner.
TEST(Octree, PlanesByCostSpareTestsInSparseScenes) {
  std::vector<Triangle> all;
  Rng rng(11);
  const auto near = [&] {
    return Vec3d{7 + rng.uniform(0, 0.1), 7 + rng.uniform(0, 0.1), 7 + rng.uniform(0, 0.1)};
  };
  for (int i = 0; i < 1000; ++i) all.push_back({near(), near(), near()});
  all.push_back({Vec3d{-9, -9, -9}, Vec3d{9, -9, -9}, Vec3d{9, 9, -9}});
  all.push_back({Vec3d{-9, -9, 9}, Vec3d{9, -9, 9}, Vec3d{9, 9, 9}});
  const ScenePtr scene = triangles(all);
  const std::string common = "octree:max_depth=3";
  EXPECT_LT(build(scene, common)->report().sah_cost * 2,
            build(scene, common + ",split=middle")->report().sah_cost);
}

TEST(Octree, BothTraversalsVisitTheSameLeaves) {
  const ScenePtr scene = soup(3000, 0.02, 3);
  const std::vector<Ray> rays = rays_through(*scene, 500);
  BatchContext context;
  context.count_work = true;
  for (const std::string kind : kKinds) {
    const std::string more = kind == "octree" ? ":" : ",";
    std::vector<Hit> down(rays.size()), along(rays.size());
    const auto walk = build(scene, kind)->closest_hit(make_batch(rays), down, context);
    const auto climb = build(scene, kind + more + "traversal=neighbour")
                           ->closest_hit(make_batch(rays), along, context);
    EXPECT_EQ(walk.counters.leaves, climb.counters.leaves) << kind;
    EXPECT_EQ(walk.counters.empty_leaves, climb.counters.empty_leaves) << kind;
    EXPECT_EQ(walk.counters.primitives, climb.counters.primitives) << kind;
    EXPECT_LT(walk.counters.traversal_steps, climb.counters.traversal_steps) << kind;
  }
}

/// Tiles in planes of cells that are exact powers of two, and rays through their corners, along
/// their edges and within their planes.
TEST(Octree, AnswersLikeBruteForceWhereRaysTouchPlanes) {
  std::vector<Triangle> all;
  for (int i = 0; i < 300; ++i) {
    Vec3d at{i % 7 * 1.0, i / 7 % 7 * 1.0, i / 49 * 1.0}, u, v;
    u[i % 3] = 1, v[(i + 1) % 3] = 1;
    all.push_back({at, at + u, at + v});
  }
  all.push_back({Vec3d{0, 0, 0}, Vec3d{8, 0, 0}, Vec3d{0, 8, 8}});
  std::vector<Ray> rays = rays_through(*triangles(all), 100);
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    const Vec3d a = all[i][0], b = all[i][1], c = all[(7 * i + 5) % 300][2];
    rays.push_back({a - 4.0 * (b - a), b - a});
    if (!(a == c)) rays.push_back({a - 2.0 * (c - a), c - a});
    rays.push_back({{a.x, a.y, -1}, {0, 0, 1}});
    rays.push_back({{9, a.y, a.z}, {-1, 0, 0}});
  }
  const ScenePtr scene = triangles(all);
  const RayBatch batch = make_batch(rays);
  std::vector<Hit> expected(rays.size()), got(rays.size());
  std::vector<std::uint32_t> expected_counts(rays.size()), counts(rays.size());
  build(scene, "brute_force")->closest_hit(batch, expected);
  build(scene, "brute_force")->count_hits(batch, expected_counts);
  for (const std::string kind : kKinds)
    for (const char* more : {"max_depth=5", "padding=0,max_depth=4", "traversal=neighbour"}) {
      const auto tree = build(scene, kind + (kind == "octree" ? ":" : ",") + more);
      EXPECT_NO_THROW(tree->validate()) << kind << " " << more;
      tree->closest_hit(batch, got);
      tree->count_hits(batch, counts);
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) wrong += !is_same_hit(got[i], expected[i]);
      EXPECT_EQ(wrong, 0u) << kind << " " << more;
      EXPECT_EQ(counts, expected_counts) << kind << " " << more;
    }
}

TEST(Octree, StopsOnTenThousandEqualTriangles) {
  const Triangle one{Vec3d{0, 0, 0}, Vec3d{1, 0.25, 0}, Vec3d{0, 1, 0.5}};
  const ScenePtr scene = triangles(std::vector<Triangle>(10000, one));
  for (const char* kind : kKinds) {
    const auto tree = build(scene, kind);
    EXPECT_NO_THROW(tree->validate()) << kind;
    EXPECT_LE(tree->report().references, 80000u) << kind;
    EXPECT_EQ(tree->closest_hit({{0.2, 0.3, -1}, {0, 0, 1}}).id.prim, 0u) << kind;
  }
}

TEST(Octree, StopsAroundAVertexOfManyTriangles) {
  Rng rng(4);
  std::vector<Triangle> fan;
  for (int i = 0; i < 2000; ++i)
    fan.push_back({Vec3d{0.3, 0.3, 0.3}, Vec3d{rng.uniform(), rng.uniform(), rng.uniform()},
                   Vec3d{rng.uniform(), rng.uniform(), rng.uniform()}});
  const ScenePtr scene = triangles(fan);
  for (const char* kind : {"octree:max_depth=32", "octree:max_depth=32,place=inner"}) {
    const auto tree = build(scene, kind);
    EXPECT_NO_THROW(tree->validate()) << kind;
    EXPECT_LE(tree->report().references, 16000u) << kind;
    EXPECT_LE(tree->report().depth, 32u) << kind;
  }
}

TEST(Octree, DividesAFlatSceneWithoutDoublingIt) {
  std::vector<Triangle> tiles;
  for (int i = 0; i < 32; ++i)
    for (int j = 0; j < 32; ++j) {
      const Vec3d at{0.1 + i, 0.2 + j, 0.25};
      tiles.push_back({at, at + Vec3d{0.7, 0, 0}, at + Vec3d{0, 0.7, 0}});
    }
  const ScenePtr scene = triangles(tiles);
  const auto tree = build(scene, "octree:max_prims=1,max_depth=8,padding=0,split=middle");
  EXPECT_NO_THROW(tree->validate());
  EXPECT_LE(tree->report().references, 2 * scene->size());
  EXPECT_GE(tree->report().depth, 5u);
}

TEST(Octree, StopsWhereNoDoubleLiesBetweenTheSidesOfACell) {
  const double next = 0x1p-52;
  std::vector<Triangle> all;
  for (int i = 0; i < 20; ++i)
    all.push_back({Vec3d{1, 1, 1}, Vec3d{1 + next, 1, 1}, Vec3d{1, 1 + next, 1 + 2 * next}});
  for (const char* kind : kKinds) {
    const auto tree = build(triangles(all), kind);
    EXPECT_NO_THROW(tree->validate()) << kind;
  }
}

TEST(Octree, IsTheSameTreeForAnyNumberOfThreads) {
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  const ScenePtr scene = soup(30000, 0.01, 6);
  for (const char* kind : kKinds) {
    const auto serial = build(scene, kind);
    for (const int threads : {2, 4}) {
      BuildContext context;
      context.executor = Executor::with_threads(threads);
      const auto parallel = build(scene, kind, context);
      EXPECT_EQ(parallel->tree_hash(), serial->tree_hash()) << kind;
      EXPECT_EQ(parallel->report().sah_cost, serial->report().sah_cost) << kind;
      EXPECT_EQ(parallel->report().bytes, serial->report().bytes) << kind;
    }
  }
}

TEST(Octree, KeepsReferencesWithinTheGivenGrowth) {
  const ScenePtr scene = soup(300, 0.4, 7);
  for (const auto& [spec, most] : {std::pair("octree:max_prims=1,max_growth=1", 300u),
                                   std::pair("octree:max_prims=1,max_growth=4", 1200u),
                                   std::pair("octree:max_prims=1,max_growth=16", 4800u)}) {
    const auto tree = build(scene, spec);
    EXPECT_NO_THROW(tree->validate());
    EXPECT_LE(tree->report().references, most);
    EXPECT_GE(tree->report().references, most / 4);
  }
}

TEST(Octree, KeepsToTheMemoryLimit) {
  const ScenePtr scene = soup(5000, 0.3, 8);
  for (const char* kind :
       {"octree:max_growth=1000,max_prims=1,max_depth=12", "octree:place=inner"}) {
    BuildContext context;
    context.memory_limit = 300'000;
    try {
      build(scene, kind, context);
      ADD_FAILURE() << "built beyond the limit";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::resource);
    }
  }
}

TEST(Octree, CanBeCancelledWhileItIsBuilt) {
  const ScenePtr scene = soup(40000, 0.002, 9);
  BuildContext context;
  double last = 0.0;
  context.progress = [&](double fraction, std::string_view stage) {
    if (stage != "building") return true;
    EXPECT_GE(fraction, last);
    last = fraction;
    return fraction < 0.5;
  };
  EXPECT_THROW(build(scene, "octree", context), Error);
  EXPECT_GE(last, 0.5);
  EXPECT_LT(last, 0.6);
}

TEST(Octree, RefusesBadOptionsByName) {
  const ScenePtr scene = soup(1, 0.1, 10);
  for (const char* spec : {"octree:max_prims=0", "octree:max_depth=33", "octree:split=end",
                           "octree:looseness=0.5", "octree:undivided=x"})
    EXPECT_THROW(build(scene, spec), Error) << spec;
}

}  // namespace
}  // namespace strahl
