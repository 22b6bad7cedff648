// query/float_rays.h - the rays of a batch as floats, where it holds nothing else.
#pragma once

#include <cstring>
#include <limits>

#include <strahl/query/ray_batch.h>

namespace strahl {

/// Whether all numbers of the batch are floats and no ray has a filter.
inline bool is_plain(const RayBatch& batch) {
  const bool is_float = !batch.org.is_double && !batch.dir.is_double &&
                        !(batch.t_min && batch.t_min->is_double) &&
                        !(batch.t_max && batch.t_max->is_double);
  return is_float && batch.masks.empty() && batch.excluded.empty() && batch.after.empty() &&
         batch.cull_per_ray.empty() && !batch.cull_back;
}

/// View of a plain batch, which must outlive it.
class FloatRays {
 public:
  /// A number or vector of ray 0, and bytes to that of the next ray.
  struct Strided {
    const std::byte* data;
    std::size_t stride;
  };

  explicit FloatRays(const RayBatch& batch)
      : size_(batch.size()),
        org_{batch.org.data, batch.org.stride},
        dir_{batch.dir.data, batch.dir.stride},
        t_min_{batch.t_min ? batch.t_min->data : bytes_of(kZero),
               batch.t_min ? batch.t_min->stride : 0},
        t_max_{batch.t_max ? batch.t_max->data : bytes_of(kInfinity),
               batch.t_max ? batch.t_max->stride : 0} {}

  std::size_t size() const { return size_; }
  const Strided& orgs() const { return org_; }
  const Strided& dirs() const { return dir_; }
  const Strided& t_mins() const { return t_min_; }
  const Strided& t_maxs() const { return t_max_; }
  Vec3f org(std::size_t i) const { return vec(org_, i); }
  Vec3f dir(std::size_t i) const { return vec(dir_, i); }
  float t_min(std::size_t i) const { return load(t_min_.data + i * t_min_.stride); }
  float t_max(std::size_t i) const { return load(t_max_.data + i * t_max_.stride); }

 private:
  static constexpr float kZero = 0.0f, kInfinity = std::numeric_limits<float>::infinity();

  static const std::byte* bytes_of(const float& value) {
    return reinterpret_cast<const std::byte*>(&value);
  }
  static float load(const std::byte* p) {
    float v;
    std::memcpy(&v, p, sizeof v);
    return v;
  }
  static Vec3f vec(const Strided& view, std::size_t i) {
    const std::byte* p = view.data + i * view.stride;
    return {load(p), load(p + 4), load(p + 8)};
  }

  std::size_t size_;
  Strided org_, dir_, t_min_, t_max_;
};

}  // namespace strahl
