// io/ray_file.h - rays from NPY files, read in place.
//
// Layout: (N,6) `ox oy oz dx dy dz` or (N,8) with `t_min t_max`, f4 or f8; beside it per-ray arrays
// for masks, excluded primitives and resume cursors.
// Thread safety: const access from any number of threads.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include <strahl/io/npy.h>
#include <strahl/query/ray_batch.h>

namespace strahl {

/// Files of per-ray values beside the rays; empty paths: none.
struct RayFilePaths {
  std::filesystem::path rays;
  std::filesystem::path masks;     ///< (N,) u4
  std::filesystem::path excluded;  ///< (N,3) u4: instance, geometry, primitive
  std::filesystem::path after;     ///< (N,4) f8: t, instance, geometry, primitive
};

class RayFile {
 public:
  /// Maps the files; costs their headers only. Throws Error{bad_input} for another dtype or shape
  /// or a length that is not that of the rays, saying what was got.
  explicit RayFile(const RayFilePaths& paths);

  std::size_t size() const { return size_; }
  std::uint64_t bytes() const { return rays_.bytes(); }

  /// A run of the rays, together with memory for what cannot be used in place.
  struct Chunk {
    RayBatch rays;
    std::vector<PrimitiveId> excluded;
    std::vector<Cursor> after;
  };
  /// Rays [first, first + count) as views of the files; valid while this object and chunk live.
  /// Cursor ids that are no numbers 0..2^32-1 throw Error{bad_input} naming the row.
  void load(std::size_t first, std::size_t count, Chunk& chunk) const;

 private:
  NpyView rays_;
  std::optional<NpyView> masks_, excluded_, after_;
  std::size_t size_ = 0, columns_ = 0;
};

}  // namespace strahl
