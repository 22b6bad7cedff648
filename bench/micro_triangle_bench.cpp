// What exactness costs: the scalar exact triangle test beside a plain double Moeller-Trumbore
// [Moeller1997] on the same random rays, half of which hit; both medians and their ratio.
//
// Both tests read the same vertices, give t, and add it up so that nothing is optimised away.
#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include <strahl/base/rng.h>
#include <strahl/geometry/triangle.h>

namespace {

using namespace strahl;

constexpr std::size_t kPairs = 4096;  // a power of two: odd steps visit all
constexpr int kRepetitions = 15;

struct Workload {
  std::vector<TriangleVertices> triangles;
  std::vector<PreparedRay> rays;
};

Vec3d random_point(Rng& rng) {
  const double x = rng.uniform(-1, 1), y = rng.uniform(-1, 1);
  return {x, y, rng.uniform(-1, 1)};
}

std::optional<double> moeller_trumbore(const PreparedRay& ray, const TriangleVertices& tri) {
  const Vec3d ab = tri.b - tri.a, ac = tri.c - tri.a;
  const Vec3d p = cross(ray.dir, ac);
  const double det = dot(ab, p);
  if (det == 0.0) return std::nullopt;
  const double inverse = 1.0 / det;
  const Vec3d s = ray.org - tri.a;
  const double u = dot(s, p) * inverse;
  if (u < 0.0 || u > 1.0) return std::nullopt;
  const Vec3d q = cross(s, ab);
  const double v = dot(ray.dir, q) * inverse;
  if (v < 0.0 || u + v > 1.0) return std::nullopt;
  return dot(ac, q) * inverse;
}

std::optional<double> exact(const PreparedRay& ray, const TriangleVertices& tri) {
  const std::optional<TriangleHit> hit = intersect(ray, tri);
  if (!hit) return std::nullopt;
  return hit->t;
}

/// Random float32 triangles and rays in random order, every other ray aimed inside its triangle.
const Workload& workload() {
  static const Workload made = [] {
    Rng rng(1);
    Workload w;
    std::size_t hits = 0, misses = 0;
    RayFrame frame;
    frame.bounds = {{-1, -1, -1}, {1, 1, 1}};
    while (w.rays.size() < kPairs) {
      const auto point = [&] { return Vec3d(Vec3f(random_point(rng))); };
      const TriangleVertices tri{point(), point(), point()};
      const Vec3d org = 2.0 * point();
      const PreparedRay ray({org, Vec3d(Vec3f(point() - org))}, frame);
      std::size_t& seen = moeller_trumbore(ray, tri) ? hits : misses;
      if (seen == kPairs / 2) continue;
      ++seen;
      w.triangles.push_back(tri), w.rays.push_back(ray);
    }
    for (std::uint32_t i = kPairs; i > 1; --i) {
      const std::uint32_t j = rng.below(i);
      std::swap(w.triangles[i - 1], w.triangles[j]), std::swap(w.rays[i - 1], w.rays[j]);
    }
    return w;
  }();
  return made;
}

template <std::optional<double> (*Test)(const PreparedRay&, const TriangleVertices&)>
void run(benchmark::State& state) {
  const Workload& w = workload();
  std::size_t hits = 0, pass = 0;
  for (auto _ : state) {
    double sum = 0.0;
    hits = 0, ++pass;
    for (std::size_t k = 0; k < kPairs; ++k) {
      // Another order in every pass, lest the branch predictor learn the answers by heart.
      const std::size_t i = (k * (2 * pass + 1) + 7 * pass) % kPairs;
      if (const std::optional<double> t = Test(w.rays[i], w.triangles[i])) sum += *t, ++hits;
    }
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kPairs));
  state.counters["hit_share"] = static_cast<double>(hits) / static_cast<double>(kPairs);
}

/// Prints as the console does and keeps the medians.
class RatioReporter : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& one : runs)
      if (one.aggregate_name == "median")
        (one.run_name.function_name == "exact" ? exact_ : plain_) = one.GetAdjustedCPUTime();
  }
  void print_ratio() const {
    std::printf("exact %.2f ns, moeller_trumbore %.2f ns per test (medians), ratio %.3f\n",
                1e3 * exact_ / kPairs, 1e3 * plain_ / kPairs, exact_ / plain_);
  }

 private:
  double exact_ = 0.0, plain_ = 0.0;
};

void add(const char* name, void (*function)(benchmark::State&)) {
  benchmark::RegisterBenchmark(name, function)
      ->Unit(benchmark::kMicrosecond)
      ->Repetitions(kRepetitions)
      ->MinTime(0.1)
      ->ReportAggregatesOnly();
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  add("exact", run<exact>);
  add("moeller_trumbore", run<moeller_trumbore>);
  RatioReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  reporter.print_ratio();
  return 0;
}
