// structures/wide_bvh/wide_limits-inl.h - where rays that certainly cross a triangle do so, against
// their limits, in doubles: a ray per lane.
//
// Rays that start on a surface or a little above it cross its triangles so near their beginning
//   that floats cannot say on which side; all of one triangle are asked at once here, and only what
//   doubles cannot say either is left to the exact test.
// Bounds: numerator N = (a - o) . n and denominator D = d . n of t, n = (b - a) x (c - a), have
//   monomials of at most eight roundings, u = 2^-53, so errors of at most 9.24 u times the product
//   of the rows' norms (wide_filter.h). With |b - a| |c - a| <= 3 q, q the product of their largest
//   components, and 1-norms of a - o and d: 27.8 u q |a - o|_1 and 27.8 u q |d|_1; 64 u = 2^-47
//   covers the roundings of what is computed of them, too. With these errors eN and eD and D > eD,
//     N - l D > eN + |l| eD + 2^-39 |l| D
//   says that t exceeds the limit l by 2^-39 |l|, so the canonical t, which is within 2^-40 of
//   t relatively (geometry/triangle.h), exceeds l. The other side is alike.
// Per-target code: included under foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_LIMITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_LIMITS_INL_H_
#undef STRAHL_WIDE_LIMITS_INL_H_
#else
#define STRAHL_WIDE_LIMITS_INL_H_
#endif

#include <algorithm>
#include <cmath>

#include <strahl/structures/wide_bvh/wide_expand-inl.h>
#include <strahl/structures/wide_bvh/wide_kernel.h>
#include <strahl/structures/wide_bvh/wide_node-inl.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

/// A triangle whose stored corners are the scene's, of a tree that keeps its coordinates.
class LimitTest {
 public:
  using D = hn::CappedTag<double, 8>;
  using V = hn::Vec<D>;
  static constexpr auto kLanes = static_cast<std::uint32_t>(hn::MaxLanes(D()));

  LimitTest(const BlockView& block, std::uint32_t lane) {
    const std::size_t stride = block.stride;
    const float* corner = corner_row(block.at, block.stride, 0) + lane;
    double ab[3], ac[3], ab_most = 0, ac_most = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      a_[i] = double{corner[i * stride]};
      ab[i] = double{corner[(i + 3) * stride]} - a_[i];
      ac[i] = double{corner[(i + 6) * stride]} - a_[i];
      ab_most = std::max(ab_most, std::abs(ab[i])), ac_most = std::max(ac_most, std::abs(ac[i]));
    }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      n_[i] = ab[j] * ac[k] - ab[k] * ac[j];
    }
    unit_ = 0x1p-47 * ab_most * ac_most;
  }

  /// Bits of rays whose crossing counts, whatever else is known, and of those where it does not.
  struct Bits {
    std::uint32_t hit, missed;
  };
  /// Of these rays (bits from `first` on), all of which certainly cross the triangle.
  HWY_INLINE Bits decide(const WideJob& job, std::uint32_t first, std::uint32_t crossing) const {
    constexpr std::uint32_t kPart = (1u << kLanes) - 1;
    Bits all{0, 0};
    for (std::uint32_t i = 0; i < kWideMaxLanes; i += kLanes) {
      if ((crossing >> i & kPart) == 0) continue;
      const Bits part = run(job.rays, job.answers, first + i);
      all.hit |= part.hit << i, all.missed |= part.missed << i;
    }
    return {all.hit & crossing, all.missed & crossing};
  }

 private:
  /// The frame's t.
  struct Quotient {
    V numerator, denominator, numerator_error, denominator_error;

    HWY_INLINE hn::Mask<D> is_above(V limit) const {
      return hn::Gt(hn::NegMulAdd(limit, denominator, numerator), error(limit));
    }
    HWY_INLINE hn::Mask<D> is_below(V limit) const {
      return hn::Gt(hn::MulSub(limit, denominator, numerator), error(limit));
    }
    HWY_INLINE V error(V limit) const {
      const V share = hn::MulAdd(hn::Set(D(), 0x1p-39), denominator, denominator_error);
      return hn::MulAdd(hn::Abs(limit), share, numerator_error);
    }
  };

  /// As many rays as a register has lanes.
  HWY_INLINE Bits run(const WideRays& rays, const WideAnswers& answers, std::uint32_t first) const {
    V numerator = hn::Zero(D()), denominator = numerator, distance = numerator, length = numerator;
    for (int i = 0; i < 3; ++i) {
      const V s = hn::Sub(hn::Set(D(), a_[i]), load(rays.org[i] + first));
      const V d = load(rays.given[i] + first), n = hn::Set(D(), n_[i]);
      numerator = hn::MulAdd(s, n, numerator), denominator = hn::MulAdd(d, n, denominator);
      distance = hn::Add(distance, hn::Abs(s)), length = hn::Add(length, hn::Abs(d));
    }
    const V per_t = load(rays.per_t + first), unit = hn::Set(D(), unit_);
    const V sign = hn::And(denominator, hn::SignBit(D()));
    const Quotient t{hn::Mul(hn::Xor(numerator, sign), per_t), hn::Abs(denominator),
                     hn::Mul(hn::Mul(unit, distance), per_t), hn::Mul(unit, length)};
    const auto is_certain = hn::Gt(t.denominator, t.denominator_error);
    const auto counts = hn::And(t.is_above(load(rays.t_enter_sure + first)),
                                t.is_below(load(answers.lower + first)));
    const auto is_out =
        hn::Or(t.is_below(load(rays.t_enter + first)), t.is_above(load(answers.upper + first)));
    return {bits_of(D(), hn::And(is_certain, counts)), bits_of(D(), hn::And(is_certain, is_out))};
  }

  HWY_INLINE static V load(const float* row) {
    return hn::PromoteTo(D(), hn::Load(hn::Rebind<float, D>(), row));
  }

  double a_[3], n_[3];
  double unit_;  ///< error of a product with n, per length of the other factor
};

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
