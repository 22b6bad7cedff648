// structures/wide_bvh/wide_take-inl.h - float rays of the caller's memory put into rows.
//
// Four vectors at a time, by transposing what 16 bytes from each one's beginning hold: its three
//   numbers and one more, which in records of eight numbers is the ray's t_min or t_max. Those 16
//   bytes are the caller's, as the next ray begins at least 4 bytes further on; the last ray
//   of a batch is copied first.
// Per-target code: included under foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_TAKE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_TAKE_INL_H_
#undef STRAHL_WIDE_TAKE_INL_H_
#else
#define STRAHL_WIDE_TAKE_INL_H_
#endif

#include <algorithm>

#include <strahl/query/float_rays.h>
#include <strahl/structures/wide_bvh/wide_node-inl.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

/// A ray's vector and the number behind it.
using Quad = float[4];

/// Puts quads into rows x, y, z and w.
HWY_INLINE void put_transposed(const std::byte* const (&quads)[4], float* x, float* y, float* z,
                               float* w) {
#if HWY_TARGET == HWY_SCALAR
  for (std::uint32_t i = 0; i < 4; ++i) {
    Quad quad;
    std::memcpy(quad, quads[i], sizeof quad);
    x[i] = quad[0], y[i] = quad[1], z[i] = quad[2], w[i] = quad[3];
  }
#else
  const hn::CappedTag<float, 4> d;
  const hn::RepartitionToWide<decltype(d)> pairs;
  const auto load = [&](int i) { return hn::LoadU(d, reinterpret_cast<const float*>(quads[i])); };
  const auto v0 = load(0), v1 = load(1), v2 = load(2), v3 = load(3);
  const auto xy01 = hn::BitCast(pairs, hn::InterleaveLower(d, v0, v1));
  const auto xy23 = hn::BitCast(pairs, hn::InterleaveLower(d, v2, v3));
  const auto zw01 = hn::BitCast(pairs, hn::InterleaveUpper(d, v0, v1));
  const auto zw23 = hn::BitCast(pairs, hn::InterleaveUpper(d, v2, v3));
  hn::Store(hn::BitCast(d, hn::InterleaveLower(pairs, xy01, xy23)), d, x);
  hn::Store(hn::BitCast(d, hn::InterleaveUpper(pairs, xy01, xy23)), d, y);
  hn::Store(hn::BitCast(d, hn::InterleaveLower(pairs, zw01, zw23)), d, z);
  hn::Store(hn::BitCast(d, hn::InterleaveUpper(pairs, zw01, zw23)), d, w);
#endif
}

/// Rays first .. first + count - 1 of a batch and, up to the end of a register, the last again.
class Taking {
 public:
  HWY_INLINE Taking(const FloatRays& given, std::size_t first, std::uint32_t count)
      : first_(first),
        last_(count - 1),
        padded_((count + kWideMaxLanes - 1) / kWideMaxLanes * kWideMaxLanes),
        is_end_(first + count == given.size()) {}

  /// Vectors, and the numbers that belong to them.
  HWY_INLINE void run(const FloatRays::Strided& vectors, const FloatRays::Strided& numbers,
                      WideRays::Row (&rows)[3], WideRays::Row& row) const {
    const bool is_joined =
        numbers.data == vectors.data + sizeof(float[3]) && numbers.stride == vectors.stride;
    take_vectors(vectors, is_joined, rows, row);
    if (!is_joined) take_numbers(numbers, row);
  }

 private:
  HWY_INLINE void take_vectors(const FloatRays::Strided& vectors, bool is_joined,
                               WideRays::Row (&rows)[3], WideRays::Row& behind) const {
    if (!is_joined && vectors.stride < sizeof(float)) return take_one_by_one(vectors, rows);
    const std::byte* begin = vectors.data + first_ * vectors.stride;
    const std::byte* last = begin + last_ * vectors.stride;
    Quad copy{};
    if (is_end_ && !is_joined) {
      std::memcpy(copy, last, sizeof(float[3]));
      last = reinterpret_cast<const std::byte*>(copy);
    }
    for (std::uint32_t i = 0; i < padded_; i += 4) {
      const std::byte* quads[4];
      for (std::uint32_t k = 0; k < 4; ++k)
        quads[k] = i + k < last_ ? begin + (i + k) * vectors.stride : last;
      put_transposed(quads, rows[0] + i, rows[1] + i, rows[2] + i, behind + i);
    }
  }

  /// Where the next ray's vector is no further on, one vector of all rays say.
  HWY_INLINE void take_one_by_one(const FloatRays::Strided& vectors,
                                  WideRays::Row (&rows)[3]) const {
    for (std::uint32_t i = 0; i < padded_; ++i) {
      float v[3];
      std::memcpy(v, vectors.data + (first_ + std::min(i, last_)) * vectors.stride, sizeof v);
      for (int a = 0; a < 3; ++a) rows[a][i] = v[a];
    }
  }

  HWY_INLINE void take_numbers(const FloatRays::Strided& numbers, WideRays::Row& row) const {
    const std::byte* begin = numbers.data + first_ * numbers.stride;
    for (std::uint32_t i = 0; i < padded_; ++i)
      std::memcpy(row + i, begin + std::min(i, last_) * numbers.stride, sizeof(float));
  }

  std::size_t first_;
  std::uint32_t last_, padded_;
  bool is_end_;
};

/// Puts rays first .. first + count - 1 into a block: t_min into t_enter, t_max into upper.
inline void take(WideRays& rays, const FloatRays& given, std::size_t first, std::uint32_t count) {
  const Taking taking(given, first, count);
  taking.run(given.orgs(), given.t_mins(), rays.org, rays.t_enter);
  taking.run(given.dirs(), given.t_maxs(), rays.given, rays.upper);
}

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
