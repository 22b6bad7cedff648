// apps/strahl/peer/float_rays.h - rays of a workload as 32-byte records, the form both sides read.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <strahl/measure/workloads.h>

namespace strahl::peer {

struct FloatRay {
  Vec3f org;
  float t_min;
  Vec3f dir;
  float t_max;
};
static_assert(sizeof(FloatRay) == 32);

/// Without rounding: workloads hold values of floats.
inline std::vector<FloatRay> float_rays(const std::vector<Ray>& rays) {
  std::vector<FloatRay> out;
  out.reserve(rays.size());
  for (const Ray& ray : rays)
    out.push_back({Vec3f(ray.org), static_cast<float>(ray.t_min), Vec3f(ray.dir),
                   static_cast<float>(ray.t_max)});
  return out;
}

/// A batch over rays in memory, which must outlive it.
inline RayBatch batch_of(std::span<const FloatRay> rays) {
  const auto* base = reinterpret_cast<const std::byte*>(rays.data());
  constexpr std::size_t kStride = sizeof(FloatRay);
  RayBatch batch;
  batch.org = {base + offsetof(FloatRay, org), rays.size(), kStride, false};
  batch.dir = {base + offsetof(FloatRay, dir), rays.size(), kStride, false};
  batch.t_min = ScalarView{base + offsetof(FloatRay, t_min), kStride, false};
  batch.t_max = ScalarView{base + offsetof(FloatRay, t_max), kStride, false};
  return batch;
}

}  // namespace strahl::peer
