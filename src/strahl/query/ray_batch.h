// query/ray_batch.h - many rays as strided views of the caller's memory; nothing is copied.
#pragma once

#include <optional>
#include <span>

#include <strahl/query/hit.h>

namespace strahl {

/// Strided view of float32 or float64 numbers. Does not own the memory.
struct ScalarView {
  const std::byte* data = nullptr;
  std::size_t stride = 0;
  bool is_double = false;

  double operator[](std::size_t i) const {
    const std::byte* p = data + i * stride;
    return is_double ? load<double>(p) : static_cast<double>(load<float>(p));
  }

 private:
  template <class T>
  static T load(const std::byte* p) {
    T v;
    std::memcpy(&v, p, sizeof v);
    return v;
  }
};

/// A hit to resume after: only hits behind it in the order of hits are seen.
struct Cursor {
  double t;
  PrimitiveId id;
};

/// n rays. org and dir have n entries; the optional spans are empty or have n entries, too. The
/// caller keeps all memory alive and unchanged during a call.
struct RayBatch {
  VertexView org, dir;                         ///< n positions and directions
  std::optional<ScalarView> t_min, t_max;      ///< default 0 and +inf
  std::span<const std::uint32_t> masks;        ///< default all ones
  std::span<const PrimitiveId> excluded;       ///< default none
  std::span<const Cursor> after;               ///< default none
  std::span<const std::uint8_t> cull_per_ray;  ///< non-zero: only front sides
  bool cull_back = false;                      ///< for all rays

  std::size_t size() const { return org.count; }
  Ray ray(std::size_t i) const;
  HitFilter filter(std::size_t i) const;
};

/// Throws Error{usage} when spans disagree in length or a view has no memory.
void check(const RayBatch& batch);

/// A batch over contiguous rays in memory.
RayBatch make_batch(std::span<const Ray> rays);

}  // namespace strahl
