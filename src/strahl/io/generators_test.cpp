// io/generators_test.cpp - texts of generators, and what the mesh generators promise.
#include <algorithm>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/base/hash.h>
#include <strahl/io/generators.h>

namespace strahl {
namespace {

const TriangleMesh& mesh_of(const SceneData& data) { return data.geometries.at(0).mesh; }

std::string hash_of(const std::string& spec) {
  const SceneData data = generate_scene(spec);
  Hash64 hash;
  for (const Geometry& geometry : data.geometries) {
    const TriangleMesh& mesh = geometry.mesh;
    for (std::size_t i = 0; i < mesh.vertices.count; ++i) {
      for (int axis = 0; axis < 3; ++axis) hash.add(mesh.vertices[i][axis]);
    }
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      const IndexView::Triple t = mesh.triangles[i];
      for (const std::uint64_t corner : {t.a, t.b, t.c}) hash.add(corner);
    }
    for (const Sphere& s : geometry.spheres) hash.add(s.center.x + s.radius);
    for (const Cone& c : geometry.cones) hash.add(c.apex.x + c.base.y);
  }
  return to_hex(hash.digest());
}

// Every edge is used once in each direction.
bool is_closed(const TriangleMesh& mesh) {
  std::set<std::pair<std::uint64_t, std::uint64_t>> edges;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const IndexView::Triple t = mesh.triangles[i];
    for (const auto& edge : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)}) {
      if (!edges.insert(edge).second) return false;
    }
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    return edges.count({edge.second, edge.first}) == 1;
  });
}

double signed_volume(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const TriangleVertices t = mesh[i];
    volume += dot(t.a, cross(t.b, t.c)) / 6.0;
  }
  return volume;
}

Aabb box_of(const TriangleMesh& mesh) {
  Aabb box;
  for (std::size_t i = 0; i < mesh.vertices.count; ++i) box.extend(mesh.vertices[i]);
  return box;
}

ErrorCode code_of(const std::string& spec, const std::string& needle) {
  try {
    generate_scene(spec);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(needle), std::string::npos) << error.what();
    return error.code();
  }
  ADD_FAILURE() << spec << " was accepted";
  return ErrorCode::cancelled;
}

TEST(Generators, BadTextsAreUsageErrorsThatSayWhatIsExpected) {
  for (const auto& [spec, needle] : std::vector<std::pair<std::string, std::string>>{
           {"gen:ball", "unknown generator 'ball'; known are balls gears"},
           {"gen:", "unknown generator ''"},
           {"", "unknown generator ''"},
           {"gen:Balls", "unknown generator 'Balls'"},
           {"gen:balls:0", "got size '0', expected a whole number in 1..16"},
           {"gen:balls:-1", "got size '-1'"},
           {"gen:balls:17", "got size '17'"},
           {"gen:balls:4.5", "got size '4.5'"},
           {"gen:balls:", "got size ''"},
           {"gen:balls:99999999999999999999", "got size '99999999999999999999'"},
           {"gen:balls:4:5", "got size '4:5'"},
           {"gen:balls:4,", "expected key=value, got ''"},
           {"gen:balls:4,,seed=1", "expected key=value, got ''"},
           {"gen:balls:4,precision", "expected key=value, got 'precision'"},
           {"gen:balls:4,=6", "expected key=value, got '=6'"},
           {"gen:balls:4,precision=g7", "balls.precision"},
           {"gen:balls:4,colour=red", "colour"},
           {"gen:balls:1,seed=1,seed=2", "seed"},
           {"gen:icosphere:3,radius=0", "icosphere.radius"},
           {"gen:icosphere:3,radius=nan", "icosphere.radius"},
           {"gen:sticks:3,rotate=31", "sticks.rotate"}}) {
    EXPECT_EQ(code_of(spec, needle), ErrorCode::usage) << spec;
  }
}

TEST(Generators, ScenesAboveAHundredMillionPrimitivesAreRefusedBeforeTheyAreMade) {
  for (const GeneratorInfo& info : generator_list()) {
    if (info.name == "stadium") continue;  // its size is a scale
    EXPECT_EQ(code_of("gen:" + info.name + ":" + std::to_string(info.max_size), "100 million"),
              ErrorCode::resource)
        << info.name;
  }
  EXPECT_EQ(code_of("gen:sphereflake:6,level=4", "100 million"), ErrorCode::resource);
  EXPECT_EQ(code_of("gen:soup:100000001", "100 million"), ErrorCode::resource);
}

TEST(Generators, TheListNamesEveryGeneratorAndItsKeys) {
  std::vector<std::string> names;
  for (const GeneratorInfo& info : generator_list()) {
    names.push_back(info.name);
    EXPECT_LE(info.min_size, info.default_size) << info.name;
    EXPECT_LE(info.default_size, info.max_size) << info.name;
    EXPECT_FALSE(info.help.empty() || info.size_help.empty()) << info.name;
    EXPECT_EQ(info.options.back().name, "seed") << info.name;
  }
  EXPECT_EQ(names,
            (std::vector<std::string>{"balls", "gears", "jacks", "lattice", "mount", "rings",
                                      "sombrero", "teapot", "tetra", "tree", "shells", "icosphere",
                                      "sphereflake", "stadium", "soup", "sticks", "terrain"}));
}

TEST(Generators, TheSmallestSizeOfEveryGeneratorWorks) {
  for (const GeneratorInfo& info : generator_list()) {
    const SceneData data = generate_scene(info.name + ":" + std::to_string(info.min_size));
    ASSERT_FALSE(data.geometries.empty()) << info.name;
    for (const Geometry& geometry : data.geometries) EXPECT_GT(geometry.size(), 0u) << info.name;
  }
}

TEST(Generators, TheSizeMayBeLeftOutBeforeOptions) {
  EXPECT_EQ(hash_of("gen:soup:edge=0.1"), hash_of("soup:10000,edge=0.1"));
  EXPECT_EQ(hash_of("gen:icosphere"), hash_of("icosphere:4"));
}

TEST(Generators, TheSameTextGivesTheSameSceneAndAnotherSeedAnother) {
  for (const GeneratorInfo& info : generator_list()) {
    EXPECT_EQ(hash_of(info.name), hash_of("gen:" + info.name)) << info.name;
  }
  for (const std::string name : {"soup", "sticks", "terrain"}) {
    const std::string spec = name + ":30,seed=";
    EXPECT_NE(hash_of(spec + "1"), hash_of(spec + "2")) << name;
    EXPECT_EQ(hash_of(spec + "0"), hash_of(name + ":30")) << name;
  }
}

TEST(Generators, MeshesAreTheSameBitsOnEveryPlatform) {
  const std::map<std::string, std::string> published{{"icosphere:6", "b7c7836d9a3ccca0"},
                                                     {"sphereflake:2", "9d9a49013f8553f5"},
                                                     {"stadium", "d1f818ccf9eeef30"},
                                                     {"soup:1000", "3c381789918ddb3e"},
                                                     {"sticks:20,rotate=30", "f13c09a1661025cd"},
                                                     {"terrain:100", "1d7a7ba25604a324"}};
  for (const auto& [spec, hash] : published) EXPECT_EQ(hash_of(spec), hash) << spec;
}

TEST(Icosphere, IsAClosedOutwardSphereOfTwentyTimesFourToTheLevelTriangles) {
  for (int level = 0; level <= 6; ++level) {
    const SceneData data = generate_scene("icosphere:" + std::to_string(level));
    const TriangleMesh& mesh = mesh_of(data);
    EXPECT_EQ(mesh.size(), 20u << (2 * level));
    EXPECT_EQ(mesh.vertices.count, (10u << (2 * level)) + 2);
    EXPECT_FALSE(mesh.vertices.is_double);
    EXPECT_TRUE(is_closed(mesh)) << level;
    for (std::size_t i = 0; i < mesh.vertices.count; ++i) {
      ASSERT_NEAR(length(mesh.vertices[i]), 1.0, 1e-7);
    }
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      const TriangleVertices t = mesh[i];
      ASSERT_GT(dot(cross(t.b - t.a, t.c - t.a), t.a + t.b + t.c), 0.0);
    }
  }
  EXPECT_NEAR(signed_volume(mesh_of(generate_scene("icosphere:6"))), 4.18879, 1e-3);
}

TEST(Icosphere, TrianglesOfALevelAreOfSimilarSize) {
  const SceneData data = generate_scene("icosphere:5");
  double smallest = 1e9, largest = 0.0;
  for (std::size_t i = 0; i < mesh_of(data).size(); ++i) {
    const TriangleVertices t = mesh_of(data)[i];
    const double area = length(cross(t.b - t.a, t.c - t.a));
    smallest = std::min(smallest, area), largest = std::max(largest, area);
  }
  EXPECT_LT(largest / smallest, 2.0);
}

TEST(Icosphere, RadiusAndOffsetMoveItAndFarAwayItStaysClosed) {
  const Aabb box =
      box_of(mesh_of(generate_scene("icosphere:3,radius=2,ox=1,oy=10,oz=-5,offset=100")));
  EXPECT_LT(norm_max(box.center() - Vec3d{101, 110, 95}), 0.05);
  EXPECT_NEAR(box.extent().x, 4.0, 0.1);
  EXPECT_TRUE(is_closed(mesh_of(generate_scene("icosphere:5,offset=1e6"))));
}

TEST(Sphereflake, HasTheSpheresOfBallsAndEachIsClosed) {
  const SceneData mesh = generate_scene("sphereflake:2,level=1");
  ASSERT_EQ(mesh_of(mesh).size(), 91u * 80);
  EXPECT_TRUE(is_closed(mesh_of(mesh)));
  EXPECT_EQ(generate_scene("sphereflake:2,level=1,floor=on").geometries[0].size(), 91u * 80 + 2);

  const NffScene balls = *generate_nff_scene("balls:2,precision=full");
  for (std::size_t k = 0; k < balls.spheres.size(); ++k) {
    // 42 vertices a sphere, symmetric about its centre.
    Vec3d center;
    for (std::size_t i = 0; i < 42; ++i) center = center + mesh_of(mesh).vertices[42 * k + i];
    EXPECT_LT(norm_max(center / 42.0 - balls.spheres[k].center), 1e-6) << k;
    const Vec3d on_sphere = mesh_of(mesh).vertices[42 * k];
    EXPECT_NEAR(length(on_sphere - balls.spheres[k].center), balls.spheres[k].radius, 1e-6) << k;
  }
}

TEST(Stadium, HasFiveThousandTrianglesAndATeapotOfTheGivenScale) {
  for (const int ratio : {1, 600, 1000000}) {
    const SceneData data = generate_scene("stadium:" + std::to_string(ratio) + ",steps=4");
    const TriangleMesh& mesh = mesh_of(data);
    ASSERT_EQ(mesh.size(), 5000u + 64 * 16 - 32);
    Aabb teapot, stadium;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      (i < 5000 ? stadium : teapot).extend(mesh[i].bounds());
    }
    EXPECT_NEAR(stadium.extent().x, 182.88, 1e-9);
    EXPECT_NEAR(stadium.extent().x / teapot.extent().x / ratio, 1.0, 0.01);
    EXPECT_EQ(data.geometries[0].materials[4999], 0u);
    EXPECT_EQ(data.geometries[0].materials[5000], 1u);
    ASSERT_TRUE(data.view);
  }
}

TEST(Stadium, FieldAndStandsFaceUpAndInward) {
  const SceneData data = generate_scene("stadium:600,steps=1");
  const auto normal = [&](std::size_t i) {
    const TriangleVertices t = mesh_of(data)[i];
    return cross(t.b - t.a, t.c - t.a);
  };
  for (std::size_t i = 0; i < 40; ++i) EXPECT_GT(normal(i).z, 0.0);
  for (std::size_t i = 40; i < 4840; ++i) {
    const Vec3d a = mesh_of(data)[i].a;
    EXPECT_GT(normal(i).z - normal(i).x * a.x - normal(i).y * a.y, 0.0) << i;
  }
}

TEST(Soup, TrianglesHaveTheirFirstCornerInTheUnitCubeAndTheOthersNearIt) {
  const SceneData data = generate_scene("soup:2000,edge=0.25,seed=7");
  ASSERT_EQ(mesh_of(data).size(), 2000u);
  Aabb corners;
  for (std::size_t i = 0; i < 2000; ++i) {
    const TriangleVertices t = mesh_of(data)[i];
    corners.extend(t.a);
    EXPECT_LE(std::max(norm_max(t.b - t.a), norm_max(t.c - t.a)), 0.25 + 1e-6);
  }
  EXPECT_TRUE((Aabb{Vec3d::all(0), Vec3d::all(1)}).contains(corners));
  EXPECT_GT(corners.extent().x, 0.99);
}

TEST(Sticks, AreClosedLongBoxesInTwoDirections) {
  for (const std::string turn : {"0", "30", "45"}) {
    const SceneData data = generate_scene("sticks:10,width=0.1,rotate=" + turn);
    const TriangleMesh& mesh = mesh_of(data);
    ASSERT_EQ(mesh.size(), 240u);
    EXPECT_TRUE(is_closed(mesh));
    EXPECT_NEAR(signed_volume(mesh), 20 * 10 * 0.1 * 0.1, 1e-4);
  }
  const SceneData straight = generate_scene("sticks:10,width=0.1,jitter=0");
  const Aabb box = box_of(mesh_of(straight));
  EXPECT_NEAR(box.extent().x, 10.0, 1e-5);
  EXPECT_NEAR(box.extent().z, 0.1, 1e-6);
}

TEST(Terrain, IsARoughSquareOfTheGivenExtentThatFacesUp) {
  for (const int n : {2, 3, 64, 129}) {
    const SceneData data = generate_scene("terrain:" + std::to_string(n) + ",extent=10,height=2");
    const TriangleMesh& mesh = mesh_of(data);
    ASSERT_EQ(mesh.size(), 2u * static_cast<std::size_t>((n - 1) * (n - 1)));
    const Aabb box = box_of(mesh);
    EXPECT_EQ(box.extent().x, 10.0);
    EXPECT_EQ(box.extent().y, 10.0);
    EXPECT_LE(box.extent().z, 8.0);
    EXPECT_GT(box.extent().z, n > 3 ? 0.5 : -1.0);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      const TriangleVertices t = mesh[i];
      ASSERT_GT(cross(t.b - t.a, t.c - t.a).z, 0.0);
    }
  }
  EXPECT_EQ(box_of(mesh_of(generate_scene("terrain:33,height=0"))).extent().z, 0.0);
}

}  // namespace
}  // namespace strahl
