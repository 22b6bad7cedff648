// structures/wide_bvh/wide_pencil-inl.h - which triangles of a block a pencil of rays can meet.
//
// A pencil is a block of rays from one point, as a camera's are. LeafTest::project() makes det, U
//   and V of each triangle scalar products d . D, d . U and d . V; over all directions of the
//   pencil, d = c + h with |h| known by component, d . U is at most c . U + |h| . |U|. Where det
//   has one sign for all of them and U, V or W stays below what LeafTest would refuse, no ray can
//   hit.
// Rounding: what LeafTest computes is within 3 u |d| . |U| of d . U for the stored U, W within
//   6 u |d| . (|D| + |U| + |V|), u = 2^-24; so is what is computed here. |h| is widened by 2^-19
//   |c| for that, and W by 2^-19 |c| . (|D| + |U| + |V|). So only lanes are left out that LeafTest
//   would refuse for every ray.
// Per-target code: included under foreach_target, once per instruction set.
#if defined(STRAHL_WIDE_PENCIL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef STRAHL_WIDE_PENCIL_INL_H_
#undef STRAHL_WIDE_PENCIL_INL_H_
#else
#define STRAHL_WIDE_PENCIL_INL_H_
#endif

#include <strahl/structures/wide_bvh/wide_leaf-inl.h>

HWY_BEFORE_NAMESPACE();
namespace strahl {
namespace HWY_NAMESPACE {

/// The directions of a block. Nodes of one register.
template <int W>
class PencilCull {
 public:
  using L = WideLanes<W>;
  using D = typename L::D;
  using V = typename L::V;
  using Pencil = typename LeafTest<W>::Pencil;

  PencilCull() = default;
  /// @param rays of a whole block
  explicit PencilCull(const WideRays& rays) {
    for (int a = 0; a < 3; ++a) {
      V low = hn::Load(D(), rays.dir[a]), high = low;
      for (std::uint32_t i = hn::MaxLanes(D()); i < kWideBlock; i += hn::MaxLanes(D())) {
        const V dir = hn::Load(D(), rays.dir[a] + i);
        low = hn::Min(low, dir), high = hn::Max(high, dir);
      }
      const V half = hn::Set(D(), 0.5f), first = hn::MinOfLanes(D(), low);
      const V last = hn::MaxOfLanes(D(), high);
      middle_[a] = hn::Mul(half, hn::Add(first, last));
      blur_[a] = hn::Mul(hn::Set(D(), 0x1p-19f), hn::Max(hn::Abs(first), hn::Abs(last)));
      half_[a] = hn::MulAdd(half, hn::Sub(last, first), blur_[a]);
    }
  }

  /// Bits of the triangles that may be hit.
  HWY_INLINE std::uint32_t lanes(const Pencil& pencil) const {
    const Range det = range(pencil.det);
    const V sign = hn::And(det.middle, hn::SignBit(D()));
    const V error = hn::Load(D(), pencil.error);
    const Range u = range(pencil.u), v = range(pencil.v);
    const auto is_definite = hn::Gt(hn::Abs(det.middle), det.half);
    const auto misses = hn::Or(hn::Lt(most(u, sign), error), hn::Lt(most(v, sign), error));
    const auto misses_w = hn::Lt(most(rest(pencil), sign), error);
    return ~bits_of(D(), hn::And(is_definite, hn::Or(misses, misses_w)));
  }

 private:
  /// Of a scalar product.
  struct Range {
    V middle, half;
  };
  HWY_INLINE Range range(const float (&rows)[3][W]) const {
    const V x = hn::Load(D(), rows[0]), y = hn::Load(D(), rows[1]), z = hn::Load(D(), rows[2]);
    return {dot(middle_, x, y, z), dot(half_, hn::Abs(x), hn::Abs(y), hn::Abs(z))};
  }
  /// Of W.
  HWY_INLINE Range rest(const Pencil& p) const {
    V w[3], size[3];
    for (int a = 0; a < 3; ++a) {
      const V det = hn::Load(D(), p.det[a]), u = hn::Load(D(), p.u[a]), v = hn::Load(D(), p.v[a]);
      w[a] = hn::Sub(hn::Sub(det, u), v);
      size[a] = hn::Add(hn::Add(hn::Abs(det), hn::Abs(u)), hn::Abs(v));
    }
    const V half = dot(half_, hn::Abs(w[0]), hn::Abs(w[1]), hn::Abs(w[2]));
    return {dot(middle_, w[0], w[1], w[2]), hn::Add(half, dot(blur_, size[0], size[1], size[2]))};
  }
  HWY_INLINE static V most(const Range& range, V sign) {
    return hn::Add(hn::Xor(range.middle, sign), range.half);
  }
  HWY_INLINE static V dot(const V (&a)[3], V x, V y, V z) {
    return hn::MulAdd(a[2], z, hn::MulAdd(a[1], y, hn::Mul(a[0], x)));
  }

  V middle_[3], half_[3], blur_[3];
};

}  // namespace HWY_NAMESPACE
}  // namespace strahl
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
