// structures/wide_bvh/wide_settle-inl.h - the canonical t of a block's candidates, a ray per lane.
//
// The operations and their order are those of crossing_t() in geometry/triangle.h, so the bits are,
//   too. Lanes where it would go on to exact numbers are left to it.
// Per-target code: included under foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_SETTLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_SETTLE_INL_H_
#undef STRAHL_WIDE_SETTLE_INL_H_
#else
#define STRAHL_WIDE_SETTLE_INL_H_
#endif

#include <strahl/structures/wide_bvh/wide_compact.h>
#include <strahl/structures/wide_bvh/wide_doubles-inl.h>
#include <strahl/structures/wide_bvh/wide_kernel.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

/// Corners of candidates as blocks of the tree hold them.
class StoredCorners {
 public:
  alignas(64) float rows[9][kWideBlock];

  /// Returns whether the block has the very corners.
  HWY_INLINE bool put(const WideTree& tree, const WideAnswers& answers, std::uint32_t ray) {
    const WideId leaf = answers.candidate[ray];
    const std::byte* block = tree.at(leaf);
    const std::uint32_t lanes = lanes_of(leaf);
    if (HWY_UNLIKELY(is_compact(block)))
      return !is_rounded(block) && put_indexed(block, lanes, answers.lane[ray], ray);
    const float* corner = corner_row(block, lanes, 0) + answers.lane[ray];
    for (int row = 0; row < 9; ++row, corner += lanes) rows[row][ray] = *corner;
    return true;
  }

 private:
  HWY_INLINE bool put_indexed(const std::byte* block, std::uint32_t lanes, std::uint32_t lane,
                              std::uint32_t ray) {
    const std::uint32_t size = distinct_of(block);
    const float* const tables = distinct_row(block, lanes, 0);
    const std::uint8_t* index = index_row(block, lanes, 0) + lane;
    for (int corner = 0; corner < 3; ++corner, index += lanes)
      for (int axis = 0; axis < 3; ++axis)
        rows[3 * corner + axis][ray] = tables[static_cast<std::uint32_t>(axis) * size + *index];
    return true;
  }
};

/// Rays of one register of doubles.
class Settlement : Doubles {
 public:
  using Doubles::kLanes;

  /// @param corners nine rows of floats or doubles
  template <class Row>
  Settlement(const WideRays& rays, const Row* corners, std::uint32_t first)
      : org_(load(rays.org, first)), dir_(load(rays.given, first)) {
    const V3 a = load(corners, first);
    ab_ = minus(load(corners + 3, first), a), ac_ = minus(load(corners + 6, first), a);
    to_a_ = minus(a, org_);
  }

  /// @return bits of the lanes whose t is certain
  HWY_INLINE std::uint32_t run(double* t) const {
    const V3 n = cross(ab_, ac_);
    const V numerator = dot(to_a_, n), denominator = dot(dir_, n);
    const V needed = hn::Mul(hn::Mul(hn::Set(D(), 18 * 0x1p-11), norm_max(ab_)), norm_max(ac_));
    const auto certain = hn::And(hn::Gt(hn::Abs(numerator), hn::Mul(needed, norm1(to_a_))),
                                 hn::Gt(hn::Abs(denominator), hn::Mul(needed, norm1(dir_))));
    hn::Store(hn::Add(hn::Div(numerator, denominator), hn::Zero(D())), D(), t);  // no -0
    return bits_of(D(), certain);
  }

 private:
  V3 org_, dir_, ab_, ac_, to_a_;
};

/// Bits of rays that have a candidate.
inline std::uint64_t candidates_of(const WideAnswers& answers) {
  const hn::CappedTag<std::uint32_t, 16> du;
  std::uint64_t bits = 0;
  for (std::uint32_t i = 0; i < kWideBlock; i += static_cast<std::uint32_t>(hn::MaxLanes(du))) {
    const auto is_none = hn::Eq(hn::Load(du, answers.candidate + i), hn::Zero(du));
    bits |= std::uint64_t{bits_of(du, hn::Not(is_none))} << i;
  }
  return bits;
}

/// Canonical t of candidates with these corners.
/// @return bits of those whose t is certain; of the others it is undefined
template <class Row>
HWY_INLINE std::uint64_t settle_rows(const WideRays& rays, const Row* corners,
                                     std::uint64_t candidates, double* t) {
  std::uint64_t certain = 0;
  constexpr std::uint64_t kGroup = (std::uint64_t{1} << Settlement::kLanes) - 1;
  for (std::uint32_t first = 0; first < kWideBlock; first += Settlement::kLanes) {
    if ((candidates >> first & kGroup) == 0) continue;
    certain |= std::uint64_t{Settlement(rays, corners, first).run(t + first)} << first;
  }
  return certain & candidates;
}

/// The corners are in the tree where it holds the very corners, else none is certain.
inline WideSettled settle(const WideTree& tree, const WideRays& rays, const WideAnswers& answers,
                          double* t) {
  const std::uint64_t candidates = candidates_of(answers);
  if (candidates == 0 || !tree.has_exact_corners) return {0, candidates};
  StoredCorners corners;
  std::uint64_t known = 0;
  for (std::uint64_t rest = candidates; rest != 0; rest &= rest - 1) {
    const auto ray = static_cast<std::uint32_t>(__builtin_ctzll(rest));
    known |= std::uint64_t{corners.put(tree, answers, ray)} << ray;
  }
  const std::uint64_t certain = settle_rows(rays, corners.rows, known, t);
  return {certain, candidates & ~certain};
}

inline std::uint64_t settle_given(const WideRays& rays, const WideCorners& corners,
                                  std::uint64_t candidates, double* t) {
  return settle_rows(rays, corners.rows, candidates, t);
}

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
