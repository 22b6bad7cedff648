// What a batch asks of heap, locks and system does not grow with the number of its rays.
#include <cstdlib>
#include <tests/per_ray/counted_calls.h>
#include <tests/per_ray/no_system_calls.h>
#include <vector>

#include <gtest/gtest.h>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/load.h>
#include <strahl/structures/wide_bvh/wide_kernel.h>

namespace strahl::test {
namespace {

constexpr std::size_t kFew = 1000, kMany = 20'000;

struct FloatRay {
  Vec3f org, dir;
};

/// Half of them at vertices, so that the exact test has work, too.
std::vector<FloatRay> float_rays(const Scene& scene, std::size_t count) {
  Rng rng(1);
  const Aabb box = scene.total_bounds();
  const auto point = [&] {
    Vec3d p;
    for (int a = 0; a < 3; ++a) p[a] = rng.uniform(2 * box.lo[a], 2 * box.hi[a]);
    return p;
  };
  std::vector<FloatRay> rays;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d org = point();
    Vec3d target = point();
    TriangleVertices corners;
    if (i % 2 == 0 && scene.triangle(rng.below(scene.size()), corners)) target = corners.b;
    rays.push_back({Vec3f(org), Vec3f(target - Vec3d(Vec3f(org)))});
  }
  return rays;
}

RayBatch batch_of(const std::vector<FloatRay>& rays, std::size_t count) {
  const auto* data = reinterpret_cast<const std::byte*>(rays.data());
  RayBatch batch;
  batch.org = {data, count, sizeof(FloatRay), false};
  batch.dir = {data + sizeof(Vec3f), count, sizeof(FloatRay), false};
  return batch;
}

std::vector<Ray> double_rays(const std::vector<FloatRay>& rays) {
  std::vector<Ray> out;
  for (const FloatRay& ray : rays) out.push_back({Vec3d(ray.org), Vec3d(ray.dir) * (1.0 / 3.0)});
  return out;
}

/// Room for the answers of any batch, and the rays, made once.
struct Bench {
  explicit Bench(const Scene& scene)
      : floats(float_rays(scene, kMany)),
        doubles(double_rays(floats)),
        hits(kMany),
        any(kMany),
        counts(kMany),
        sides(kMany) {}

  void closest(const Accelerator& on, const RayBatch& batch, const BatchContext& context) {
    on.closest_hit(batch, std::span(hits).first(batch.size()), context);
  }
  void others(const Accelerator& on, const RayBatch& batch, const BatchContext& context) {
    on.any_hit(batch, std::span(any).first(batch.size()), context);
    on.count_hits(batch, std::span(counts).first(batch.size()), context);
    on.inside(batch, std::span(sides).first(batch.size()), context);
  }
  void trace(const Accelerator& on, std::size_t count, const BatchContext& context) {
    for (const RayBatch& batch :
         {batch_of(floats, count), make_batch(std::span(doubles).first(count))}) {
      closest(on, batch, context);
      others(on, batch, context);
    }
  }
  Calls calls(const Accelerator& on, std::size_t count, const BatchContext& context) {
    const Calls before = calls_so_far();
    trace(on, count, context);
    const Calls after = calls_so_far();
    return {after.allocations - before.allocations, after.locks - before.locks};
  }

  std::vector<FloatRay> floats;
  std::vector<Ray> doubles;
  std::vector<Hit> hits;
  std::vector<std::uint8_t> any;
  std::vector<std::uint32_t> counts;
  std::vector<Side> sides;
};

/// "wide_bvh" with an instruction set, or another SPEC.
struct Case {
  std::string spec, isa;
};

std::vector<Case> cases() {
  std::vector<Case> all{{"bvh", ""},
                        {"wide_bvh:batch=single", ""},
                        {"wide_bvh:quality=high", ""},
                        {"wide_bvh:layout=compact", ""}};
  for (const WideKernel* kernel : wide_kernels()) all.push_back({"wide_bvh", kernel->isa});
  return all;
}

std::string name_of(const testing::TestParamInfo<Case>& tested) {
  std::string name = tested.param.spec + "_" + tested.param.isa;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

class PerRay : public testing::TestWithParam<Case> {
 protected:
  PerRay() {
    if (!GetParam().isa.empty()) ::setenv("STRAHL_ISA", GetParam().isa.c_str(), 1);
    accelerator = build(scene, GetParam().spec);
    ::unsetenv("STRAHL_ISA");
    bench.trace(*accelerator, 100, {});  // what is made once has been made
    (void)accelerator->closest_hit(bench.doubles[0]);
  }
  std::shared_ptr<const Scene> scene =
      std::make_shared<const Scene>(load_scene_data("gen:icosphere:3"));
  std::unique_ptr<Accelerator> accelerator;
  Bench bench{*scene};
};

TEST_P(PerRay, HeapAndLocksAreAskedPerBatchOnly) {
  if (!STRAHL_COUNTS_CALLS) GTEST_SKIP() << "calls are not counted under this sanitizer";
  const Calls few = bench.calls(*accelerator, kFew, {}),
              many = bench.calls(*accelerator, kMany, {});
  // The lists of hits that `count` and `inside` reuse double now and then.
  EXPECT_LE(many.allocations, few.allocations + 64);
  EXPECT_LT(many.allocations, 700u);
  EXPECT_EQ(many.locks, few.locks);
  EXPECT_GT(many.locks, 0u) << "not counted";
  EXPECT_GT(many.allocations, 0u) << "not counted";
}

TEST_P(PerRay, ClosestAndAnyHitsAllocateTheSameForAnyNumber) {
  if (!STRAHL_COUNTS_CALLS) GTEST_SKIP() << "calls are not counted under this sanitizer";
  Calls seen[2];
  for (int run = 0; run < 2; ++run) {
    const std::size_t count = run == 0 ? kFew : kMany;
    const Calls before = calls_so_far();
    bench.closest(*accelerator, batch_of(bench.floats, count), {});
    accelerator->any_hit(batch_of(bench.floats, count), std::span(bench.any).first(count));
    const Calls after = calls_so_far();
    seen[run] = {after.allocations - before.allocations, after.locks - before.locks};
  }
  EXPECT_EQ(seen[0], seen[1]);
  EXPECT_LE(seen[1].allocations, 40u);
}

TEST_P(PerRay, ASingleRayAllocatesNothing) {
  if (!STRAHL_COUNTS_CALLS) GTEST_SKIP() << "calls are not counted under this sanitizer";
  const std::uint64_t before = calls_so_far().allocations;
  for (std::size_t i = 0; i < kFew; ++i) bench.hits[i] = accelerator->closest_hit(bench.doubles[i]);
  EXPECT_EQ(calls_so_far().allocations, before);
}

TEST_P(PerRay, ThreadsAskPerBatchToo) {
  if (!STRAHL_COUNTS_CALLS) GTEST_SKIP() << "calls are not counted under this sanitizer";
  if (!Executor::threads_available()) GTEST_SKIP() << "built without threads";
  BatchContext context;
  context.context.executor = Executor::with_threads(2);
  const Calls calls = bench.calls(*accelerator, kMany, context);
  EXPECT_LT(calls.allocations, 2000u);
  EXPECT_LT(calls.locks, 2000u);
}

TEST_P(PerRay, TracingNeedsNoSystemCall) {
  if (!can_forbid_system_calls()) GTEST_SKIP() << "system calls cannot be forbidden here";
  bench.trace(*accelerator, kMany, {});  // the heap has what it needs
  EXPECT_TRUE(runs_without_system_calls([&] { bench.trace(*accelerator, kMany, {}); }));
  EXPECT_FALSE(runs_without_system_calls([&] { (void)::getppid(); }));
}

INSTANTIATE_TEST_SUITE_P(Structures, PerRay, testing::ValuesIn(cases()), name_of);

}  // namespace
}  // namespace strahl::test
