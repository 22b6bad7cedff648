#include <array>
#include <cmath>
#include <cstddef>
#include <functional>

#include <gtest/gtest.h>

#include <strahl/base/error.h>
#include <strahl/catalog/accelerator.h>
#include <strahl/catalog/catalog.h>

namespace strahl {
namespace {

std::shared_ptr<const Scene> two_walls() {
  SceneData data;
  data.geometries.emplace_back();
  data.geometries[0].mesh = make_mesh(
      std::vector<Vec3f>{{-9, -9, 1}, {9, -9, 1}, {0, 9, 1}, {-9, -9, 2}, {9, -9, 2}, {0, 9, 2}},
      {0, 1, 2, 3, 4, 5});
  return std::make_shared<const Scene>(std::move(data));
}

std::vector<Ray> rays(std::size_t n) { return std::vector<Ray>(n, Ray{{0, 0, 0}, {0, 0, 2}}); }

ErrorCode code_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& e) {
    return e.code();
  }
  return ErrorCode::unsupported;
}

TEST(Accelerator, TIsInUnitsOfTheDirection) {
  const auto bvh = build(two_walls(), "bvh");
  const Hit hit = bvh->closest_hit(rays(1)[0]);
  EXPECT_EQ(hit.t, 0.5);
  EXPECT_EQ(hit.id, (PrimitiveId{0, 0, 0}));
}

TEST(Accelerator, LengthsMustAgree) {
  const auto bvh = build(two_walls(), "bvh");
  const auto r = rays(3);
  std::vector<Hit> hits(2);
  EXPECT_EQ(code_of([&] { bvh->closest_hit(make_batch(r), hits); }), ErrorCode::usage);
  RayBatch batch = make_batch(r);
  const std::vector<std::uint32_t> masks(2, ~0u);
  batch.masks = masks;
  hits.resize(3);
  EXPECT_EQ(code_of([&] { bvh->closest_hit(batch, hits); }), ErrorCode::usage);
  batch = make_batch(r);
  batch.dir.data = nullptr;
  EXPECT_EQ(code_of([&] { bvh->closest_hit(batch, hits); }), ErrorCode::usage);
}

TEST(Accelerator, ZeroRaysAreFine) {
  const auto bvh = build(two_walls(), "bvh");
  AllHits all;
  bvh->all_hits(RayBatch{}, all);
  EXPECT_EQ(all.splits, std::vector<std::int64_t>{0});
  EXPECT_EQ(bvh->closest_hit(RayBatch{}, {}).invalid_rays, 0u);
}

TEST(Accelerator, StridedFloatRaysOfACallerAreReadInPlace) {
  struct Particle {
    char tag;
    std::array<float, 3> position;
    double unused;
    std::array<float, 3> velocity;
  };
  std::vector<Particle> particles(5, {'p', {0, 0, 0}, 1.0, {0, 0, 1}});
  particles[3].position[2] = 1.5f;
  const auto* base = reinterpret_cast<const std::byte*>(particles.data());
  RayBatch batch;
  batch.org = {base + offsetof(Particle, position), 5, sizeof(Particle), false};
  batch.dir = {base + offsetof(Particle, velocity), 5, sizeof(Particle), false};
  std::vector<Hit> hits(5);
  build(two_walls(), "bvh")->closest_hit(batch, hits);
  EXPECT_EQ(hits[0].t, 1.0);
  EXPECT_EQ(hits[3].t, 0.5);
  EXPECT_EQ(hits[3].id.prim, 1u);
}

TEST(Accelerator, ProgressCancelsABatch) {
  const auto bvh = build(two_walls(), "bvh");
  const auto r = rays(100000);
  std::vector<Hit> hits(r.size());
  BatchContext context;
  int calls = 0;
  context.context.progress = [&](double, std::string_view) { return ++calls < 3; };
  EXPECT_EQ(code_of([&] { bvh->closest_hit(make_batch(r), hits, context); }), ErrorCode::cancelled);
  EXPECT_EQ(calls, 3);
}

TEST(Accelerator, ProgressOfABatchAscendsToOne) {
  const auto bvh = build(two_walls(), "bvh");
  const auto r = rays(100000);
  std::vector<Hit> hits(r.size());
  BatchContext context;
  double last = 0.0;
  bool ascends = true;
  context.context.progress = [&](double fraction, std::string_view) {
    ascends = ascends && fraction >= last;
    last = fraction;
    return true;
  };
  bvh->closest_hit(make_batch(r), hits, context);
  EXPECT_TRUE(ascends);
  EXPECT_EQ(last, 1.0);
}

TEST(Accelerator, AllHitsHonoursTheMemoryLimit) {
  const auto bvh = build(two_walls(), "bvh");
  const auto r = rays(5000);
  AllHits all;
  BatchContext context;
  context.context.memory_limit = 1000;
  EXPECT_EQ(code_of([&] { bvh->all_hits(make_batch(r), all, context); }), ErrorCode::resource);
  context.context.memory_limit = 10000 * sizeof(Hit);
  bvh->all_hits(make_batch(r), all, context);
  EXPECT_EQ(all.hits.size(), 10000u);
}

TEST(Accelerator, ARayInARefusedIntervalHitsNothingAndIsNotInvalid) {
  const auto bvh = build(two_walls(), "bvh");
  std::vector<Ray> r = rays(2);
  r[0].t_min = 0.75, r[0].t_max = 0.6;
  r[1].dir = {0, 0, 0};
  std::vector<Hit> hits(2);
  EXPECT_EQ(bvh->closest_hit(make_batch(r), hits).invalid_rays, 1u);
  EXPECT_FALSE(hits[0].is_hit());
  EXPECT_TRUE(std::isinf(hits[1].t));
}

}  // namespace
}  // namespace strahl
