// io/hit_file.h - answers of queries as arrays, hashed and written to NPZ files.
//
// Layout: one array per field, exactly as in the file. Memory is not touched before it is set, so
// that what is never filled costs nothing.
// Thread safety: different entries may be set from different threads.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include <strahl/io/npz.h>
#include <strahl/query/hit.h>

namespace strahl {

/// An array of fixed size whose elements are not initialised.
template <class T>
class RawArray {
 public:
  explicit RawArray(std::size_t size = 0)
      : size_(size), values_(std::make_unique_for_overwrite<T[]>(size)) {}
  T& operator[](std::size_t i) { return values_[i]; }
  const T& operator[](std::size_t i) const { return values_[i]; }
  std::span<T> span() { return {values_.get(), size_}; }
  std::span<const T> span() const { return {values_.get(), size_}; }

 private:
  std::size_t size_;
  std::unique_ptr<T[]> values_;
};

/// Bytes per hit of HitArrays.
inline constexpr std::uint64_t kHitArrayBytes = 8 + 4 * 4 + 2 * 8 + 3 * 8;

/// Hits with their surfaces.
class HitArrays {
 public:
  explicit HitArrays(std::size_t size);

  /// Writes entry i; a miss gives t = inf, ids 2^32 - 1, zeros.
  void set(std::size_t i, const Scene& scene, const Ray& ray, const Hit& hit);

  /// Adds t_hit, primitive_ids, geometry_ids, instance_ids, face_ids, primitive_uvs and
  /// primitive_normals. The arrays must live until the writer is closed.
  void add_to(NpzWriter& file) const;

  /// Of all arrays in the order above.
  std::uint64_t hash() const;

 private:
  RawArray<double> t_;
  RawArray<std::uint32_t> primitives_, geometries_, instances_, faces_;
  RawArray<double> uvs_, normals_;
};

}  // namespace strahl
