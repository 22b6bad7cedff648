// bvh_bench - what bounding volumes and orders of visits cost and save in bvh on real scenes:
//   bvh_bench SCENE [RAYS]
//
// First table, the lecture's T = n B + m I per closest hit: n volume tests per ray, m/n the share
// of them that lets the ray through, B nanoseconds per test (bounds/README.md), `rest` the
// primitive tests at I each; T is the model's sum, ns/ray what was measured. Second table: the
// four orders. Rays run from a sphere around the scene to points in its box. One thread; variants
// take turns, times are medians of seven in processor time. Exit status 1 when answers differ.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <strahl/base/rng.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/load.h>
#include <strahl/structures/bvh/volume_choice.h>

namespace {

using namespace strahl;

constexpr int kTurns = 7;

struct Variant {
  std::string spec;
  double B = 0.0;  ///< 0 where nodes differ
  std::unique_ptr<Accelerator> tree;
  std::vector<double> seconds;
  Counters work;
};

std::vector<Ray> make_rays(const Scene& scene, std::size_t count) {
  const Aabb& box = scene.total_bounds();
  const double reach = length(box.extent());
  Rng rng(1);
  const auto inside = [&](double lo, double hi) {
    const double x = rng.uniform(lo, hi), y = rng.uniform(lo, hi);
    return Vec3d{x, y, rng.uniform(lo, hi)};
  };
  std::vector<Ray> rays;
  while (rays.size() < count) {
    const Vec3d p = inside(-1, 1), q = inside(0, 1), e = box.extent();
    if (!(dot(p, p) <= 1.0 && dot(p, p) > 0.01)) continue;
    const Vec3d org = box.center() + reach * unit(p);
    rays.push_back({org, box.lo + Vec3d{q.x * e.x, q.y * e.y, q.z * e.z} - org});
  }
  return rays;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// False when a variant answers differently from the first.
bool measure(std::vector<Variant>& variants, const std::vector<Ray>& rays) {
  const RayBatch batch = make_batch(rays);
  std::vector<Hit> expected(rays.size()), hits(rays.size());
  BatchContext counting;
  counting.count_work = true;
  for (Variant& v : variants) {
    v.work = v.tree->closest_hit(batch, hits, counting).counters;
    if (&v == &variants.front()) expected = hits;
    for (std::size_t i = 0; i < hits.size(); ++i)
      if (!is_same_hit(hits[i], expected[i]) || hits[i].is_front != expected[i].is_front)
        return false;
  }
  for (int turn = 0; turn < kTurns; ++turn)
    for (Variant& v : variants) {
      const std::clock_t begin = std::clock();
      v.tree->closest_hit(batch, hits);
      v.seconds.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    }
  return true;
}

std::vector<Variant> build_variants(const std::shared_ptr<const Scene>& scene,
                                    const std::vector<std::string>& specs) {
  std::vector<Variant> variants;
  for (const std::string& spec : specs) variants.push_back({spec, 0.0, build(scene, spec), {}, {}});
  return variants;
}

void print_kinds(const std::vector<Variant>& variants, std::size_t rays) {
  const VolumeCosts costs;
  std::printf("| bv | n | m/n | B ns | rest | T ns | ns/ray | build s | SAH | MB |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|\n");
  const auto count = static_cast<double>(rays);
  for (const Variant& v : variants) {
    const double n = static_cast<double>(v.work.bounding_volumes) / count;
    const double m = static_cast<double>(v.work.traversal_steps + v.work.leaves) / count;
    const double rest = static_cast<double>(v.work.primitives) / count;
    const BuildReport report = v.tree->report();
    std::printf("| `%s` | %.1f | %.3f | ", v.spec.c_str(), n, m / n);
    if (v.B > 0.0)
      std::printf("%.1f | %.1f | %.0f |", v.B, rest, n * v.B + rest * costs.primitive);
    else
      std::printf("mixed | %.1f | |", rest);
    std::printf(" %.0f | %.2f | %.2f | %.2f |\n", 1e9 * median(v.seconds) / count, report.seconds,
                report.sah_cost, static_cast<double>(report.bytes) / 1e6);
  }
}

void print_orders(const std::vector<Variant>& variants, std::size_t rays) {
  std::printf("\n| SPEC | nodes opened | leaves | volume tests | tests | waiting | ns/ray |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  const auto per_ray = [&](std::uint64_t n) {
    return static_cast<double>(n) / static_cast<double>(rays);
  };
  for (const Variant& v : variants)
    std::printf("| `%s` | %.1f | %.1f | %.1f | %.1f | %llu | %.0f |\n", v.spec.c_str(),
                per_ray(v.work.traversal_steps), per_ray(v.work.leaves),
                per_ray(v.work.bounding_volumes), per_ray(v.work.primitives),
                static_cast<unsigned long long>(v.work.most_waiting),
                1e9 * median(v.seconds) / static_cast<double>(rays));
}

int run(const std::string& name, std::size_t count) {
  const auto scene = std::make_shared<const Scene>(load_scene_data(name));
  const std::vector<Ray> rays = make_rays(*scene, count);
  std::printf("\n%s, %u primitives\n\n", name.substr(name.find_last_of('/') + 1).c_str(),
              scene->size());
  std::vector<std::string> specs;
  for (const BoundingVolumeInfo& info : kBoundingVolumes)
    specs.push_back("bvh:bv=" + std::string(info.name));
  specs.emplace_back("bvh:bv=auto");
  std::vector<Variant> kinds = build_variants(scene, specs);
  for (std::size_t i = 0; i < kVolumeKinds; ++i) kinds[i].B = VolumeCosts{}.test[i];
  if (!measure(kinds, rays)) return 1;
  print_kinds(kinds, rays.size());
  std::vector<Variant> orders = build_variants(
      scene, {"bvh:traversal=dfs", "bvh:traversal=direction", "bvh:traversal=ordered",
              "bvh:traversal=heap", "bvh:bv=obb,traversal=dfs", "bvh:bv=obb,traversal=direction",
              "bvh:bv=obb,traversal=ordered", "bvh:bv=obb,traversal=heap"});
  if (!measure(orders, rays)) return 1;
  print_orders(orders, rays.size());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: bvh_bench SCENE [RAYS]\n");
    return 2;
  }
  try {
    const std::size_t rays = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 20000;
    return run(argv[1], std::max<std::size_t>(1, rays));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
