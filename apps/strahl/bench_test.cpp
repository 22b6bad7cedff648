// apps/strahl/bench_test.cpp - `strahl bench`: what it prints, with and without a peer, and what it
// refuses.
#include <algorithm>
#include <apps/strahl/bench_scaling.h>
#include <apps/strahl/bench_worst.h>
#include <apps/strahl/run_test.h>
#include <string>

#include <strahl/catalog/catalog.h>
#include <strahl/io/generators.h>
#include <strahl/render/framing.h>

namespace strahl::cli {
namespace {

using test::Finished;

constexpr const char* kTiny = " --size 16 --repeat 2 --json";

/// Whether this program was built with a peer; its tests are skipped where it was not.
bool has_peer() {
  try {
    peer::require_peer();
  } catch (const Error&) {
    return false;
  }
  return true;
}

std::string peer_option() { return has_peer() ? " --peer embree" : ""; }

TEST(ScaledScene, HasAboutAsManyTriangles) {
  EXPECT_EQ(scaled_scene("terrain", 1e4), "gen:terrain:72");
  EXPECT_EQ(scaled_scene("terrain", 3e7), "gen:terrain:3874");
  EXPECT_EQ(scaled_scene("soup", 1e6), "gen:soup:1000000");
  EXPECT_EQ(scaled_scene("sticks", 2400), "gen:sticks:100");
  EXPECT_EQ(scaled_scene("icosphere", 20 * 256), "gen:icosphere:4");
}

TEST(ScaledSizes, EndWithTheLargest) {
  EXPECT_EQ(scaled_sizes(1e4, 3e7, 10), (std::vector<double>{1e4, 1e5, 1e6, 1e7, 3e7}));
  EXPECT_EQ(scaled_sizes(1e4, 1e6, 10), (std::vector<double>{1e4, 1e5, 1e6}));
  EXPECT_EQ(scaled_sizes(5, 5, 2), (std::vector<double>{5}));
}

std::shared_ptr<const Scene> generated(const char* text) {
  return std::make_shared<const Scene>(generate_scene(text));
}

TEST(AimedRays, MeetTheirVerticesExactly) {
  const auto given = generated("icosphere:3");
  const double step = coarse_step(given->total_bounds());
  FlatMesh mesh = flat_mesh(*given);
  for (Vec3d& v : mesh.vertices) v = snapped(v, step);
  const auto accelerator = build(float_scene(mesh), "wide_bvh");
  const AimedRays rays = make_aimed_rays(*accelerator, mesh, step, 300, 1);
  ASSERT_EQ(rays.to_vertices.rays.size(), 300u);
  std::vector<Hit> hits(300);
  for (const RaySet* set : {&rays.to_vertices, &rays.to_insides}) {
    for (const peer::FloatRay& ray : set->rays) {
      const Vec3d end = Vec3d(ray.org) + Vec3d(ray.dir);
      const bool is_vertex =
          std::find(mesh.vertices.begin(), mesh.vertices.end(), end) != mesh.vertices.end();
      ASSERT_EQ(is_vertex, set == &rays.to_vertices);
    }
    accelerator->closest_hit(peer::batch_of(set->rays), hits);
    for (const Hit& hit : hits) ASSERT_TRUE(hit.is_hit());
  }
}

TEST(DoubleScene, HoldsNoFloatsAndRoundsToTheFloatScene) {
  const auto given = generated("terrain:12");
  const FlatMesh mesh = flat_mesh(*given);
  const auto floats = float_scene(mesh), doubles = double_scene(mesh, given->total_bounds());
  ASSERT_EQ(doubles->size(), given->size());
  const VertexView &f = floats->geometries()[0].mesh.vertices,
                   &d = doubles->geometries()[0].mesh.vertices;
  for (std::size_t i = 0; i < f.count; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NE(double{static_cast<float>(d[i][axis])}, d[i][axis]);
      if (f[i][axis] != 0.0) {
        EXPECT_EQ(double{static_cast<float>(d[i][axis])}, f[i][axis]);
      }
    }
}

/// Rays of every kind, in a number that fills no packet.
std::vector<RaySet> mixed_rays(const Accelerator& accelerator) {
  const WorkloadKind kinds[] = {WorkloadKind::primary, WorkloadKind::ao, WorkloadKind::random};
  std::vector<RaySet> sets =
      make_ray_sets(accelerator, kinds, {default_view(accelerator.scene(), 64, 64), 4096, 1}, {});
  for (RaySet& set : sets) set.rays.resize(1031);
  return sets;
}

TEST(Peer, AnswersAlikeThroughAllItsInterfaces) {
  if (!has_peer()) GTEST_SKIP() << "built without Embree";
  const auto scene = generated("tetra:5");
  const auto accelerator = build(scene, "wide_bvh");
  const auto peer = peer::make_peer(*scene, {});
  for (const RaySet& set : mixed_rays(*accelerator)) {
    Contest contest(set);
    contest.run(*accelerator);
    for (const peer::PeerApi api : peer::kPeerApis) {
      contest.run(*peer, api);
      EXPECT_LE(contest.differences(), 3u) << name_of(set.kind) << ", " << name_of(api);
    }
  }
}

class BenchCommand : public test::CommandTest {
 protected:
  nlohmann::json bench(const std::string& arguments) const {
    const Finished finished = run("bench " + arguments + kTiny);
    EXPECT_EQ(finished.code, 0) << finished.err;
    return finished.json();
  }
};

/// Null without a peer.
void expect_estimate(const nlohmann::json& row, const std::string& name) {
  if (!has_peer()) {
    EXPECT_EQ(row[name], nullptr);
    return;
  }
  EXPECT_GT(row[name + "_low"], 0.0) << row;
  EXPECT_LE(row[name + "_low"], row[name]) << row;
  EXPECT_LE(row[name], row[name + "_high"]) << row;
}

TEST(SpecFor, TakesSingleRaysOneAtATime) {
  EXPECT_EQ(spec_for(OwnApi::single, "wide_bvh"), "wide_bvh:batch=single");
  EXPECT_EQ(spec_for(OwnApi::single, "wide_bvh:quality=high"),
            "wide_bvh:quality=high,batch=single");
  EXPECT_EQ(spec_for(OwnApi::single, "wide_bvh:batch=interleaved"), "wide_bvh:batch=interleaved");
  EXPECT_EQ(spec_for(OwnApi::single, "grid"), "grid");
  EXPECT_EQ(spec_for(OwnApi::batch, "wide_bvh"), "wide_bvh");
}

TEST(MeanOf, IsGeometricAndLeavesOutRowsWithoutPeer) {
  Json a, b, none;
  add_estimate(a, "ratio", Estimate{1.0, 0.5, 2.0});
  add_estimate(b, "ratio", Estimate{4.0, 2.0, 8.0});
  add_estimate(none, "ratio", std::nullopt);
  const std::optional<Estimate> mean = mean_of({&a, &none, &b}, "ratio");
  ASSERT_TRUE(mean);
  EXPECT_DOUBLE_EQ(mean->value, 2.0);
  EXPECT_DOUBLE_EQ(mean->low, 1.0);
  EXPECT_DOUBLE_EQ(mean->high, 4.0);
  EXPECT_FALSE(mean_of({&none}, "ratio"));
}

TEST_F(BenchCommand, MeasuresAloneWithoutAPeer) {
  const auto json = bench("gen:tetra:3 --spec wide_bvh,grid");
  EXPECT_EQ(json["options"]["peer"], nullptr);
  ASSERT_EQ(json["results"].size(), 5u * 2 * 2);
  for (const auto& row : json["results"]) {
    EXPECT_GT(row["mrays"], 0.0);
    EXPECT_EQ(row["peer_mrays"], nullptr);
    EXPECT_EQ(row["ratio"], nullptr);
  }
  EXPECT_EQ(json["scenes"][0]["builds"].size(), 2u);
  EXPECT_EQ(json["summary"][0]["ratio"], nullptr);
}

TEST_F(BenchCommand, RacesThePeerOnTheSameRays) {
  if (!has_peer()) GTEST_SKIP() << "built without Embree";
  const auto json = bench("gen:terrain:40 gen:tetra:4 --peer embree");
  ASSERT_EQ(json["results"].size(), 2u * 5 * 2);
  for (const auto& row : json["results"]) {
    expect_estimate(row, "ratio");
    EXPECT_GT(row["peer_mrays"], 0.0);
    EXPECT_TRUE(row["api"] == "batch" || row["peer_api"] == "single") << row;
    // A peer over other triangles or rays would differ nearly everywhere.
    EXPECT_LE(row["differing_rays"], 2) << row;
  }
  ASSERT_EQ(json["summary"].size(), 2u * 6);
  for (const auto& row : json["summary"]) expect_estimate(row, "ratio");
  const auto& builds = json["scenes"][0]["builds"];
  EXPECT_EQ(builds[1]["spec"], "embree");
  EXPECT_GT(builds[1]["bytes_per_primitive"], 20.0);
}

TEST_F(BenchCommand, GivesThePeerInstancesInTheirPlaces) {
  if (!has_peer()) GTEST_SKIP() << "built without Embree";
  // One triangle under three nodes, two of them moved and scaled.
  folder_.write("three.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
    "scenes": [{"nodes": [0, 1, 2]}],
    "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [2, 0, 0], "scale": [3, 2, 1]},
              {"mesh": 0, "translation": [0, -3, 1]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0.25]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAIA+"}]})");
  const auto json = bench("three.gltf --peer embree --workloads primary,random");
  EXPECT_EQ(json["scenes"][0]["primitives"], 3);
  ASSERT_EQ(json["results"].size(), 4u);
  for (const auto& row : json["results"]) EXPECT_LE(row["differing_rays"], 2) << row;
}

TEST_F(BenchCommand, ComparesBuildsAndTheirTrees) {
  const auto json = bench(std::string("gen:terrain:30 --builds --threads 2") + peer_option());
  EXPECT_EQ(json["results"].size(), 0u);
  ASSERT_EQ(json["builds"].size(), 2u);
  EXPECT_EQ(json["builds"][1]["spec"], "wide_bvh:quality=fast");
  for (const char* part : {"builds", "builds_summary"}) {
    for (const auto& row : json[part]) {
      for (const char* ratio : {"time_ratio", "single_ratio", "batch_ratio"})
        expect_estimate(row, ratio);
    }
  }
  EXPECT_EQ(json["builds"][1]["peer_quality"], has_peer() ? nlohmann::json("MEDIUM") : nullptr);
  EXPECT_GT(json["builds"][0]["seconds"], 0.0);
}

TEST_F(BenchCommand, ScalesAGeneratedSceneAndDrawsIt) {
  const auto json = bench("--scaling --from 200 --to 3000 --step 4 -o out" + peer_option());
  const std::size_t engines = has_peer() ? 2 : 1;
  ASSERT_EQ(json["scaling"].size(), 3 * engines);
  EXPECT_EQ(json["scaling"][0]["triangles"], 200);
  EXPECT_EQ(json["scaling"].back()["triangles"], 3042);
  for (const auto& row : json["scaling"]) {
    EXPECT_GT(row["build_seconds"], 0.0);
    EXPECT_GT(row["bytes_per_triangle"], 20.0);
    EXPECT_LT(row["bytes_per_triangle"], 200.0);
    ASSERT_EQ(row["rays"].size(), 4u);  // primary and random, single and batch
    for (const auto& ray : row["rays"]) EXPECT_GT(ray["nanoseconds_per_ray"], 0.0);
  }
  for (const char* chart : {"time_primary", "time_random", "build", "memory"}) {
    const std::string script = folder_.read(std::string("out/charts/") + chart + ".gp");
    EXPECT_NE(script.find("\n3042 "), std::string::npos) << script;
    EXPECT_EQ(script.find("embree") != std::string::npos, has_peer()) << script;
  }
  if (std::system("command -v gnuplot > /dev/null") != 0) return;
  EXPECT_NE(folder_.read("out/charts/time_random.svg").find("nanoseconds"), std::string::npos);
}

TEST_F(BenchCommand, MeasuresWhatExactnessCosts) {
  const auto json = bench("gen:icosphere:2 gen:tetra:2 --worst --double --workload ao,random");
  EXPECT_EQ(json["results"].size(), 0u);
  ASSERT_EQ(json["worst"].size(), 2u * 2 * 2);
  ASSERT_EQ(json["doubles"].size(), 2u * 2 * 2);
  for (const char* part : {"worst", "doubles"})
    for (const auto& row : json[part]) {
      EXPECT_GT(row["ratio_low"], 0.0);
      EXPECT_LE(row["ratio_low"], row["ratio"]);
      EXPECT_GT(row["rays"], 0);
    }
}

TEST_F(BenchCommand, LeavesOutScenesWithoutTriangles) {
  const auto json = bench("gen:jacks:2 --worst --double");
  EXPECT_EQ(json["worst"].size(), 0u);
  EXPECT_EQ(json["doubles"].size(), 0u);
}

TEST_F(BenchCommand, WritesWhatItPrints) {
  const auto json = bench("gen:tetra:2 --workload random -o out");
  EXPECT_EQ(json, nlohmann::json::parse(folder_.read("out/bench.json")));
  EXPECT_EQ(json["options"]["workloads"], (std::vector<std::string>{"random"}));
  EXPECT_NE(folder_.read("out/bench.md").find("| gen:tetra:2 | random   | batch"),
            std::string::npos)
      << folder_.read("out/bench.md");
}

TEST_F(BenchCommand, AnEmptySceneIsNoError) {
  folder_.write("empty.off", "OFF\n0 0 0\n");
  const auto json = bench("empty.off" + peer_option());
  for (const auto& row : json["results"]) EXPECT_GT(row["mrays"], 0.0);
  EXPECT_EQ(json["scenes"][0]["primitives"], 0);
}

TEST_F(BenchCommand, RefusesWhatItCannotRace) {
  expect_error("bench gen:tetra:2 --peer tinybvh", 2, "embree");
  expect_error("bench gen:tetra:2 --isa mmx", 2, "mmx");
  expect_error("bench gen:tetra:2 --workload whitted", 2, "whitted");
  expect_error("bench gen:tetra:2 --workload sunny", 2, "sunny");
  expect_error("bench gen:tetra:2 --spec no_tree", 2, "no_tree");
  expect_error("bench --scaling --generator balls", 2, "terrain");
  expect_error("bench --scaling --from 100 --to 10", 2, "--from");
  expect_error("bench gen:tetra:2 --scaling", 2, "--scaling");
  expect_error("bench --worst --builds", 2, "--builds");
  expect_error("bench --from 100", 2, "--scaling");
  expect_error("bench missing.ply", 3, "missing.ply");
  // Without Embree that is what it says, with it that Embree gets triangles only.
  expect_error("bench gen:balls:1 --peer embree", 2, has_peer() ? "triangles only" : "Embree");
}

}  // namespace
}  // namespace strahl::cli
