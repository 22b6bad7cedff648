// structures/wide_bvh/wide_prepare-inl.h - float rays made ready by vectors, for a tree
// that keeps the scene's coordinates.
//
// The bounds are those of wide_ray.h with these differences. Directions are multiplied by a power
//   of two in floats, exactly but where a component underflows: then it is off by 2^-150 at most,
//   which the constant of wide_filter.h covers, and is below 2^-60 in length for the planes.
//   c = -o r is rounded twice more: spread 3.1 P + 4.1 |o| instead of 3.01 P + 2.02 |o|.
//   t_min and t_max times a power of two are exact but for underflow, which
//   float_a_little_above() and -below() cover.
// Per-target code: included under foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_PREPARE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_PREPARE_INL_H_
#undef STRAHL_WIDE_PREPARE_INL_H_
#else
#define STRAHL_WIDE_PREPARE_INL_H_
#endif

#include <strahl/structures/wide_bvh/wide_node-inl.h>
#include <strahl/structures/wide_bvh/wide_ray.h>
#include <strahl/structures/wide_bvh/wide_take-inl.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

/// As many rays as a register has lanes, from ray `first` on.
class Preparation {
 public:
  using L = WideLanes<16>;
  using D = typename L::D;
  using DI = typename L::DI;
  using V = typename L::V;

  Preparation(WideRays& rays, std::uint32_t first, float reach)
      : rays_(rays), first_(first), reach_(hn::Set(D(), reach)) {}

  /// Bits of those that suit.
  HWY_INLINE std::uint32_t run() {
    const auto suits = bits_of(D(), hn::And(make_unit(), are_near()));
    const auto in_range = bits_of(D(), limit());
    make_planes<0>(), make_planes<1>(), make_planes<2>();
    hn::Store(signs_, hn::RebindToUnsigned<D>(), rays_.signs + first_);
    hn::Store(hn::Zero(D()), D(), rays_.org_slack + first_);
    hn::Store(hn::Zero(D()), D(), rays_.t_blur2 + first_);
    return suits & in_range;
  }

 private:
  HWY_INLINE V load(const float* row) const { return hn::Load(D(), row + first_); }
  HWY_INLINE void store(V v, float* row) const { hn::Store(v, D(), row + first_); }
  HWY_INLINE static V set(float v) { return hn::Set(D(), v); }

  /// Brings the squared length into [0.25, 1.0001]: the exponent's half is taken from it.
  HWY_INLINE hn::Mask<D> make_unit() {
    const V x = load(rays_.given[0]), y = load(rays_.given[1]), z = load(rays_.given[2]);
    const V squared = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    const DI di;
    const auto exponent = hn::Sub(
        hn::ShiftRight<23>(hn::BitCast(di, hn::Mul(squared, set(0.9999f)))), hn::Set(di, 127));
    const auto half = hn::ShiftRight<1>(hn::Add(exponent, hn::Set(di, 2)));
    const auto bias = hn::Set(di, 127);
    const V scale = hn::BitCast(D(), hn::ShiftLeft<23>(hn::Sub(bias, half)));
    store(hn::Mul(x, scale), rays_.dir[0]);
    store(hn::Mul(y, scale), rays_.dir[1]);
    store(hn::Mul(z, scale), rays_.dir[2]);
    per_t_ = hn::BitCast(D(), hn::ShiftLeft<23>(hn::Add(bias, half)));
    store(per_t_, rays_.per_t);
    return hn::And(hn::Ge(squared, set(0x1p-60f)), hn::Le(squared, set(0x1p60f)));
  }

  HWY_INLINE hn::Mask<D> are_near() {
    const V x = load(rays_.org[0]), y = load(rays_.org[1]), z = load(rays_.org[2]);
    const V squared = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    const V farthest = hn::Max(hn::Max(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
    spread_ = hn::Mul(set(0x1p-24f), hn::MulAdd(set(4.1f), farthest, hn::Mul(set(3.1f), reach_)));
    return hn::Le(squared, hn::Mul(set(256.0f), hn::Mul(reach_, reach_)));
  }

  /// From t_min in t_enter and t_max in upper.
  HWY_INLINE hn::Mask<D> limit() {
    const V zero = hn::Zero(D()), given_first = load(rays_.t_enter), given_last = load(rays_.upper);
    const V first = hn::Mul(given_first, per_t_), last = hn::Mul(given_last, per_t_);
    store(hn::Max(a_little_below(first), zero), rays_.t_enter);
    store(hn::IfThenElseZero(hn::Gt(first, zero), a_little_above(first)), rays_.t_enter_sure);
    const V kept = hn::Min(last, set(kWideMostT / 2));
    store(a_little_above(kept), rays_.upper);
    store(a_little_below(kept), rays_.lower);
    const V most = set(kWideMostT);
    const auto is_first = hn::And(hn::Ge(given_first, zero), hn::Le(first, most));
    return hn::And(hn::And(is_first, hn::Le(given_first, most)), hn::Ge(given_last, zero));
  }

  template <int a>
  HWY_INLINE void make_planes() {
    const V along = hn::Add(load(rays_.dir[a]), hn::Zero(D()));  // no -0
    const V least = hn::Max(hn::Abs(along), set(0x1p-60f));
    const V r = hn::Div(set(1.0f), hn::CopySignToAbs(least, along));
    const V c = hn::Mul(hn::Neg(load(rays_.org[a])), r), pad = hn::Mul(spread_, hn::Abs(r));
    store(r, rays_.rcp[a]);
    store(hn::Sub(c, pad), rays_.near[a]);
    store(hn::Add(c, pad), rays_.far[a]);
    const hn::RebindToUnsigned<D> du;
    const auto sign = hn::ShiftRight<31>(hn::BitCast(du, along));
    signs_ = hn::Or(signs_, hn::ShiftLeft<a>(sign));
  }

  HWY_INLINE static V a_little_above(V t) {
    return hn::Add(hn::Mul(t, set(1 + 0x1p-22f)), set(1e-37f));
  }
  HWY_INLINE static V a_little_below(V t) {
    return hn::Sub(hn::Mul(t, set(1 - 0x1p-22f)), set(1e-37f));
  }

  WideRays& rays_;
  std::uint32_t first_;
  V reach_, spread_, per_t_;
  hn::Vec<hn::RebindToUnsigned<D>> signs_ = hn::Zero(hn::RebindToUnsigned<D>());
};

/// Makes rays first .. first + count - 1 of a batch the block's rays.
/// @return bits of those that suit; the others are to be set by doubles, invalid ones among them
inline std::uint64_t prepare(WideRays& rays, const FloatRays& given, std::size_t first,
                             std::uint32_t count, float reach) {
  take(rays, given, first, count);
  constexpr auto kLanes = static_cast<std::uint32_t>(WideLanes<16>::kLanes);
  std::uint64_t suited = 0;
  for (std::uint32_t i = 0; i < count; i += kLanes)
    suited |= std::uint64_t{Preparation(rays, i, reach).run()} << i;
  return suited & (~std::uint64_t{0} >> (kWideBlock - count));
}

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
