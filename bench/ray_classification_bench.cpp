// Random rays through ray_classification and bvh: the first pass, which makes cells, and the
// fastest of later passes, interleaved. Usage: ray_classification_bench RAYS PASSES SPEC SCENE...
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>

#include <strahl/base/rng.h>
#include <strahl/base/timer.h>
#include <strahl/catalog/catalog.h>
#include <strahl/io/load.h>

namespace strahl {
namespace {

/// From a sphere around the box to points in its middle, as tools/demo_rays.py makes them.
std::vector<Ray> rays_across(const Aabb& box, int count) {
  Rng rng(1);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const double z = rng.uniform(-1, 1), turn = rng.uniform(0, 2 * M_PI);
    const double flat = std::sqrt(1 - z * z);
    const Vec3d out{flat * std::cos(turn), flat * std::sin(turn), z};
    const Vec3d org = box.center() + length(box.extent()) * out;
    Vec3d target = box.center();
    for (int a = 0; a < 3; ++a) target[a] += rng.uniform(-0.25, 0.25) * box.extent()[a];
    rays.push_back({org, target - org});
  }
  return rays;
}

/// Microseconds per ray.
double trace(const Accelerator& accelerator, const std::vector<Ray>& rays, std::vector<Hit>& hits) {
  const Timer timer;
  accelerator.closest_hit(make_batch(rays), hits);
  return timer.seconds() / static_cast<double>(rays.size()) * 1e6;
}

void compare(const char* name, const char* spec, int count, int passes) {
  const auto scene = std::make_shared<const Scene>(load_scene_data(name));
  const std::vector<Ray> rays = rays_across(scene->total_bounds(), count);
  const auto bvh = build(scene, "bvh"), own = build(scene, spec);
  std::vector<Hit> hits(rays.size());
  const double cold = trace(*own, rays, hits);
  double warm = cold, peer = trace(*bvh, rays, hits);
  for (int pass = 0; pass < passes; ++pass) {
    warm = std::min(warm, trace(*own, rays, hits));
    peer = std::min(peer, trace(*bvh, rays, hits));
  }
  BatchContext counting;
  counting.count_work = true;
  const Counters work = own->closest_hit(make_batch(rays), hits, counting).counters;
  const BuildReport report = own->report();
  const double n = count;
  const char* file = std::strrchr(name, '/');
  std::printf("%-24s %8u %8.2f %9.2f %8.2f %7.1f %8.1f %7.1f %8.0f %7llu\n",
              file != nullptr ? file + 1 : name, scene->size(), peer, cold, warm, warm / peer,
              static_cast<double>(work.bounding_volumes) / n,
              static_cast<double>(work.primitives) / n,
              static_cast<double>(report.bytes) / std::max(scene->size(), 1u),
              static_cast<unsigned long long>(report.nodes));
}

int number(const char* text) {
  int value = 0;
  std::from_chars(text, text + std::strlen(text), value);
  return value;
}

}  // namespace
}  // namespace strahl

int main(int count, char** words) {
  if (count < 5) {
    std::fputs("usage: ray_classification_bench RAYS PASSES SPEC SCENE...\n", stderr);
    return 2;
  }
  std::printf("%-24s %8s %8s %9s %8s %7s %8s %7s %8s %7s\n", "scene", "size", "bvh us", "cold us",
              "warm us", "warm/bvh", "boxes", "tests", "bytes/p", "cells");
  for (int i = 4; i < count; ++i)
    strahl::compare(words[i], words[3], strahl::number(words[1]), strahl::number(words[2]));
}
