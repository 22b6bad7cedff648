#include <cstddef>
#include <string>

#include <strahl/base/error.h>
#include <strahl/query/ray_batch.h>

namespace strahl {
namespace {

void require_length(std::size_t got, std::size_t want, const char* what) {
  if (got == 0 || got == want) return;
  throw Error(ErrorCode::usage,
              std::to_string(got) + " entries for " + std::to_string(want) + " rays", what);
}

}  // namespace

Ray RayBatch::ray(std::size_t i) const {
  Ray r{org[i], dir[i]};
  if (t_min) r.t_min = (*t_min)[i];
  if (t_max) r.t_max = (*t_max)[i];
  return r;
}

HitFilter RayBatch::filter(std::size_t i) const {
  HitFilter f;
  if (!masks.empty()) f.mask = masks[i];
  if (!excluded.empty()) f.exclude = excluded[i];
  if (!after.empty()) f.after_t = after[i].t, f.after_id = after[i].id;
  f.cull_back = cull_back || (!cull_per_ray.empty() && cull_per_ray[i] != 0);
  return f;
}

void check(const RayBatch& batch) {
  const std::size_t n = batch.size();
  if (batch.dir.count != n)
    throw Error(
        ErrorCode::usage,
        std::to_string(n) + " origins but " + std::to_string(batch.dir.count) + " directions",
        "rays");
  if (n > 0 && (batch.org.data == nullptr || batch.dir.data == nullptr))
    throw Error(ErrorCode::usage, "null memory", "rays");
  require_length(batch.masks.size(), n, "masks");
  require_length(batch.excluded.size(), n, "excluded primitives");
  require_length(batch.after.size(), n, "cursors");
  require_length(batch.cull_per_ray.size(), n, "culling flags");
}

RayBatch make_batch(std::span<const Ray> rays) {
  const auto* base = reinterpret_cast<const std::byte*>(rays.data());
  RayBatch batch;
  batch.org = {base + offsetof(Ray, org), rays.size(), sizeof(Ray), true};
  batch.dir = {base + offsetof(Ray, dir), rays.size(), sizeof(Ray), true};
  batch.t_min = ScalarView{base + offsetof(Ray, t_min), sizeof(Ray), true};
  batch.t_max = ScalarView{base + offsetof(Ray, t_max), sizeof(Ray), true};
  return batch;
}

}  // namespace strahl
