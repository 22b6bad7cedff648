#include <cmath>
#include <string>

#include <strahl/base/error.h>
#include <strahl/io/ray_file.h>

namespace strahl {
namespace {

[[noreturn]] void refuse(const NpyView& file, const std::string& expected) {
  throw Error(ErrorCode::bad_input, "got " + file.description() + ", expected " + expected,
              file.which());
}

/// Opens a per-ray array of N rows; columns 0 stands for shape (N,).
std::optional<NpyView> open_rows(const std::filesystem::path& path, NpyDtype dtype,
                                 std::size_t rows, std::size_t columns,
                                 const std::string& expected) {
  if (path.empty()) return std::nullopt;
  NpyView file(path);
  std::vector<std::uint64_t> shape{rows};
  if (columns > 0) shape.push_back(columns);
  if (file.dtype() != dtype || file.shape() != shape)
    refuse(file, expected + " for " + std::to_string(rows) + " rays");
  return file;
}

std::uint32_t to_id(double value, const NpyView& file, std::size_t row) {
  if (!(value >= 0.0 && value <= 4294967295.0 && value == std::floor(value)))
    throw Error(ErrorCode::bad_input, "got id " + std::to_string(value) + ", expected 0..2^32-1",
                file.which(), "row " + std::to_string(row));
  return static_cast<std::uint32_t>(value);
}

}  // namespace

RayFile::RayFile(const RayFilePaths& paths) : rays_(paths.rays) {
  const bool is_float = rays_.dtype() == NpyDtype::f4 || rays_.dtype() == NpyDtype::f8;
  const auto& shape = rays_.shape();
  if (!is_float || shape.size() != 2 || (shape[1] != 6 && shape[1] != 8))
    refuse(rays_, "'<f4' or '<f8' of shape (N, 6) or (N, 8)");
  size_ = static_cast<std::size_t>(shape[0]), columns_ = static_cast<std::size_t>(shape[1]);
  masks_ = open_rows(paths.masks, NpyDtype::u4, size_, 0, "'<u4' of shape (N,)");
  excluded_ = open_rows(paths.excluded, NpyDtype::u4, size_, 3, "'<u4' of shape (N, 3)");
  after_ = open_rows(paths.after, NpyDtype::f8, size_, 4, "'<f8' of shape (N, 4)");
}

void RayFile::load(std::size_t first, std::size_t count, Chunk& chunk) const {
  const bool is_double = rays_.dtype() == NpyDtype::f8;
  const std::size_t width = is_double ? sizeof(double) : sizeof(float);
  const std::size_t stride = columns_ * width;
  const std::byte* base = static_cast<const std::byte*>(rays_.data()) + first * stride;
  chunk.rays = {};
  chunk.rays.org = {base, count, stride, is_double};
  chunk.rays.dir = {base + 3 * width, count, stride, is_double};
  if (columns_ == 8) {
    chunk.rays.t_min = ScalarView{base + 6 * width, stride, is_double};
    chunk.rays.t_max = ScalarView{base + 7 * width, stride, is_double};
  }
  if (masks_) chunk.rays.masks = masks_->as<std::uint32_t>().subspan(first, count);
  if (excluded_) {
    const auto ids = excluded_->as<std::uint32_t>().subspan(3 * first, 3 * count);
    chunk.excluded.clear();
    for (std::size_t i = 0; i < ids.size(); i += 3)
      chunk.excluded.push_back({ids[i], ids[i + 1], ids[i + 2]});
    chunk.rays.excluded = chunk.excluded;
  }
  if (after_) {
    const auto rows = after_->as<double>().subspan(4 * first, 4 * count);
    chunk.after.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const auto id = [&](std::size_t k) { return to_id(rows[4 * i + k], *after_, first + i); };
      chunk.after.push_back({rows[4 * i], {id(1), id(2), id(3)}});
    }
    chunk.rays.after = chunk.after;
  }
}

}  // namespace strahl
